/// The most samples that are spread over a footprint longer than it is wide.
const MAX_PROBES: f32 = 16.0;

/// The part by which a footprint may be longer than wide and still count as round. A relief that keeps its depth makes
/// footprints round up to rounding, which must not choose the number of samples, nor the axis that they lie along.
const ROUND: f32 = 1.0 / 16.0;

/// The levels by which maps are finer than the pixel: two filtered levels blur more than a pixel does.
const SHARPER: f32 = 0.5;

/// The levels by which the march is finer than the pixel: the relief's contrast counts for more than its noise.
const FINER: f32 = 1.5;

/// The most points of a footprint whose shadow is marched.
const MAX_POINTS: f32 = 8.0;

/// The pixels spanned by a whole march below which the relief has faded to its polygon, and above which it is whole.
const FLAT_BELOW: f32 = 0.5;
const WHOLE_ABOVE: f32 = 1.5;

/// The gradients of the base uv: the steps on a surface of one pixel to the right and down, in texture repeats.
///
/// Level of detail follows from it, before any loop: the levels of the maps, the level of the march, and the fading of the
/// relief.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// One pixel to the right.
    pub dx: [f32; 2],
    /// One pixel down.
    pub dy: [f32; 2],
}

/// The samples of a map whose mean covers a footprint: along its longer axis, each as wide as the shorter (McCormack et al.
/// 1999).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probes {
    /// Number of samples, 1 to 16.
    pub count: u32,
    /// The mip level of each.
    pub lod: f32,
    /// The footprint's longer axis from end to end, texture repeats.
    pub axis: [f32; 2],
}

/// The axes of the ellipse that a pixel covers, in texels of a map.
struct Axes {
    /// The vector of the longer axis.
    along: [f32; 2],
    longer: f32,
    shorter: f32,
}

impl Footprint {
    /// Returns the mip level at which the longer gradient spans one texel of a map of this size, as graphics APIs define it.
    #[must_use]
    pub fn lod(&self, size: [u32; 2]) -> f32 {
        if self.dx == [0.0; 2] && self.dy == [0.0; 2] {
            return 0.0;
        }
        let length = |d: [f32; 2]| (d[0] * size[0] as f32).hypot(d[1] * size[1] as f32);
        // log2(0) = −∞ and NaN both mean level 0.
        length(self.dx).max(length(self.dy)).log2().max(0.0)
    }

    /// Returns the samples of a map of this size.
    #[must_use]
    pub fn probes(&self, size: [u32; 2]) -> Probes {
        let axes = self.axes(size);
        // `max` first: it also turns NaN into 1.
        let count = (axes.longer / axes.shorter.max(1.0) - ROUND).ceil().max(1.0).min(MAX_PROBES);
        let lod = axes.shorter.max(axes.longer / count).max(1.0).log2();
        let lod = (lod - SHARPER).max(0.0);
        Probes { count: count as u32, lod, axis: [0, 1].map(|k| axes.along[k] / size[k] as f32) }
    }

    /// Returns the mip level whose relief is marched, of a height map of this size. A whole one: samples and cells are then
    /// those of the same surface.
    #[must_use]
    pub fn march_lod(&self, size: [u32; 2]) -> f32 {
        (self.probes(size).lod + SHARPER - FINER + 0.5).floor().max(0.0)
    }

    /// Returns the number of points of the footprint whose shadow is marched, 1 to 8: one for each texel of its length.
    #[must_use]
    pub fn points(&self, size: [u32; 2]) -> u32 {
        // `max` first: it also turns NaN into 1.
        self.axes(size).longer.ceil().max(1.0).min(MAX_POINTS) as u32
    }

    /// Returns point `i` of the footprint around `uv`: the first in the middle, all spread evenly however many there are
    /// (the R2 sequence, Roberts 2018).
    #[must_use]
    pub fn point(&self, uv: [f32; 2], i: u32) -> [f32; 2] {
        let [s, t] = [0.754_877_7, 0.569_840_3].map(|step: f32| (0.5 + step * i as f32).fract() - 0.5);
        [0, 1].map(|k| uv[k] + self.dx[k] * s + self.dy[k] * t)
    }

    /// Returns the fraction of its depth that a relief keeps which is as deep as `slope` is long (texture repeats), on a height
    /// map of this size: 1 = all, 0 where the whole march spans less than a pixel from any side and the relief is its polygon.
    #[must_use]
    pub fn fade(&self, size: [u32; 2], slope: [f32; 2]) -> f32 {
        let pixel = self.axes(size).shorter;
        let span = (slope[0] * size[0] as f32).hypot(slope[1] * size[1] as f32);
        // Written so that NaN keeps the relief.
        if !(pixel > 0.0) || !(span < WHOLE_ABOVE * pixel) {
            return 1.0;
        }
        let t = ((span / pixel - FLAT_BELOW) / (WHOLE_ABOVE - FLAT_BELOW)).max(0.0);
        t * t * (3.0 - 2.0 * t)
    }

    /// Returns the footprint on the relief itself, of which this much of the depth is left ([`Footprint::fade`]). Seen
    /// slantwise a polygon's footprint is long; but of a relief one sees the sides that face the eye, and on them the
    /// footprint is as long as it is wide.
    #[must_use]
    pub fn on_relief(&self, size: [u32; 2], fade: f32) -> Self {
        let axes = self.axes(size);
        let Axes { along, longer, shorter } = axes;
        if !(longer > 0.0) {
            return *self;
        }
        let take = fade * (1.0 - shorter / longer);
        let shrunk = |d: [f32; 2]| {
            let d = [d[0] * size[0] as f32, d[1] * size[1] as f32];
            let part = take * (d[0] * along[0] + d[1] * along[1]) / (longer * longer);
            [0, 1].map(|k| (d[k] - along[k] * part) / size[k] as f32)
        };
        Self { dx: shrunk(self.dx), dy: shrunk(self.dy) }
    }

    fn axes(&self, size: [u32; 2]) -> Axes {
        let [dx, dy] = [self.dx, self.dy].map(|d| [d[0] * size[0] as f32, d[1] * size[1] as f32]);
        // Of J·Jᵀ, whose eigenvalues are the squared half axes.
        let (a, b, c) = (dx[0] * dx[0] + dy[0] * dy[0], dx[0] * dx[1] + dy[0] * dy[1], dx[1] * dx[1] + dy[1] * dy[1]);
        let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
        let longer2 = mean + (half * half + b * b).sqrt();
        let longer = longer2.sqrt();
        let shorter = if longer > 0.0 { (dx[0] * dy[1] - dx[1] * dy[0]).abs() / longer } else { 0.0 };
        // Of the two expressions for the eigenvector the one that does not cancel.
        let v = if half >= 0.0 { [longer2 - c, b] } else { [b, longer2 - a] };
        let length = v[0].hypot(v[1]);
        let along = if length > 0.0 { v.map(|x| x * (longer / length)) } else { [longer, 0.0] };
        Axes { along, longer, shorter }
    }
}

impl Probes {
    /// Returns the uv of sample `i` for a footprint around `uv`.
    #[inline]
    #[must_use]
    pub fn uv(&self, uv: [f32; 2], i: u32) -> [f32; 2] {
        let t = (i as f32 + 0.5) / self.count as f32 - 0.5;
        [uv[0] + self.axis[0] * t, uv[1] + self.axis[1] * t]
    }
}

#[cfg(test)]
mod tests {
    use relievo_testkit::Random;

    use super::*;

    const SIZE: [u32; 2] = [256, 128];

    fn close(a: f32, b: f32) -> bool {
        (a - b).abs() <= 1e-4 * (1.0 + b.abs())
    }

    #[test]
    fn a_round_footprint_takes_one_sample_of_its_own_level() {
        let round = Footprint { dx: [4.0 / 256.0, 0.0], dy: [0.0, 4.0 / 128.0] };
        let probes = round.probes(SIZE);
        assert_eq!(probes.count, 1);
        assert!(close(probes.lod, 1.5) && close(round.lod(SIZE), 2.0), "{probes:?}");
        assert_eq!(probes.uv([0.3, 0.4], 0), [0.3, 0.4]);
    }

    #[test]
    fn a_long_footprint_takes_samples_along_it_whichever_way_the_camera_is_turned() {
        // 24 texels along (0.6, 0.8), 3 across.
        let (along, across) = ([0.6 * 24.0, 0.8 * 24.0], [-0.8 * 3.0, 0.6 * 3.0]);
        for rotation in [0.0f32, 0.4, 0.785, 2.0, 4.5] {
            let (s, c) = rotation.sin_cos();
            let combine = |p: f32, q: f32| [0, 1].map(|k| (along[k] * p + across[k] * q) / SIZE[k] as f32);
            let footprint = Footprint { dx: combine(c, s), dy: combine(-s, c) };
            let probes = footprint.probes(SIZE);
            assert!(
                (8..=9).contains(&probes.count) && (probes.lod + SHARPER - 3.0f32.log2()).abs() < 0.01,
                "{rotation}: {probes:?}"
            );
            let texels = [0, 1].map(|k| probes.axis[k] * SIZE[k] as f32);
            let (dot, length) = (texels[0] * 0.6 + texels[1] * 0.8, texels[0].hypot(texels[1]));
            assert!(close(length, 24.0) && close(dot.abs(), 24.0), "{rotation}: {texels:?}");
        }
    }

    #[test]
    fn samples_are_few_however_long_the_footprint_and_whatever_its_numbers() {
        let endless = Footprint { dx: [1e-3, 0.0], dy: [0.0, 100.0] }.probes(SIZE);
        assert!(endless.count == 16 && close(endless.lod + SHARPER, (100.0f32 * 128.0 / 16.0).log2()), "{endless:?}");
        for odd in [0.0, f32::NAN, f32::INFINITY, 1e30, 1e-30] {
            let footprint = Footprint { dx: [odd, 0.0], dy: [odd, odd] };
            let probes = footprint.probes(SIZE);
            assert!((1..=8).contains(&footprint.points(SIZE)) && !footprint.march_lod(SIZE).is_nan());
            assert!((1..=16).contains(&probes.count) && !probes.lod.is_nan(), "{odd}: {probes:?}");
            assert!((0.0..=1.0).contains(&footprint.fade(SIZE, [0.1, 0.1])), "{odd}");
        }
        let zero = Footprint::default();
        assert_eq!((zero.probes(SIZE).count, zero.probes(SIZE).lod, zero.fade(SIZE, [0.0, 0.1])), (1, 0.0, 1.0));
    }

    #[test]
    fn rounding_does_not_choose_the_samples_of_a_round_footprint() {
        let mut random = Random(1);
        let mut random = || random.unit();
        for _ in 0..10_000 {
            let (angle, side) = (random() * 6.3, 0.5 + 20.0 * random());
            let (s, c) = angle.sin_cos();
            let mut hair = || 1.0 + 2e-6 * (random() - 0.5);
            let dx = [c * side * hair() / 256.0, s * side * hair() / 128.0];
            let dy = [-s * side * hair() / 256.0, c * side * hair() / 128.0];
            let probes = Footprint { dx, dy }.probes(SIZE);
            let level = (side.log2() - SHARPER).max(0.0);
            assert!(probes.count == 1 && (probes.lod - level).abs() < 1e-4, "{side} at {angle}: {probes:?}");
        }
    }

    #[test]
    fn on_a_relief_that_is_seen_the_footprint_is_as_long_as_it_is_wide() {
        let long = Footprint { dx: [3.0 / 256.0, 0.0], dy: [4.0 / 256.0, 24.0 / 128.0] };
        let [before, half, whole] = [0.0, 0.5, 1.0].map(|fade| long.on_relief(SIZE, fade).axes(SIZE));
        assert!(close(before.longer, long.axes(SIZE).longer) && half.longer < 0.6 * before.longer);
        assert!(close(whole.longer, before.shorter) && close(whole.shorter, before.shorter));
        assert_eq!(Footprint::default().on_relief(SIZE, 1.0), Footprint::default());
    }

    #[test]
    fn a_relief_fades_evenly_as_its_march_comes_to_span_less_than_a_pixel() {
        let footprint = Footprint { dx: [8.0 / 256.0, 0.0], dy: [0.0, 8.0 / 128.0] };
        let fade = |pixels: f32| footprint.fade(SIZE, [0.0, pixels * 8.0 / 128.0]);
        assert_eq!([fade(0.0), fade(FLAT_BELOW), fade(WHOLE_ABOVE), fade(100.0)], [0.0, 0.0, 1.0, 1.0]);
        assert!(close(fade(0.5 * (FLAT_BELOW + WHOLE_ABOVE)), 0.5));
        let steps: Vec<f32> = (0..200).map(|i| fade(i as f32 * 0.01)).collect();
        assert!(steps.windows(2).all(|pair| pair[0] <= pair[1] && pair[1] - pair[0] < 0.02));
    }
}
