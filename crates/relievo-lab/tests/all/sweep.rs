//! Sweeps by the public API: restarts, independence of threads, reports.

use std::fs;
use std::path::Path;

use relievo_journal::JournalError;
use relievo_lab::{
    LabError, MarchBackend, PictureOptions, PictureRow, ResolvedTechnique, Results, SweepOptions, SweepOutcome,
    TestMaterial, corpus, sweep, write_report,
};
use relievo_map::Limits;

fn materials() -> Vec<TestMaterial> {
    ["spikes", "make:toy-box"].map(|name| TestMaterial::load(name, 64, &Limits::default()).unwrap()).into()
}

fn techniques() -> Vec<ResolvedTechnique> {
    ["normal", "tutorials", "occlusion:16..64", "exact:cells", "exact"].map(|text| text.parse().unwrap()).into()
}

fn options() -> SweepOptions {
    SweepOptions {
        angles: vec![0.0, 60.0, 82.0],
        depths: vec![5.0, 25.0],
        minifications: vec![1, 4],
        techniques: techniques(),
        rays: 256,
        rounds: 1,
        pictures: Some(PictureOptions {
            size: [32, 24],
            samples: 2,
            angles: vec![60.0],
            techniques: techniques().into_iter().filter(|technique| !technique.is_cell_by_cell()).collect(),
            ..PictureOptions::default()
        }),
    }
}

fn swept(folder: &Path, options: &SweepOptions) -> SweepOutcome {
    sweep(&materials(), options, &mut [MarchBackend::Cpu], folder, None).unwrap()
}

/// Without what no two runs share.
fn timeless(mut results: Results) -> Results {
    for row in &mut results.hits {
        (row.ns_per_ray, row.build_ms) = (0.0, 0.0);
    }
    results
}

/// Cases per material: two depths and two minifications of hits, two of pictures.
const CASES: usize = 2 * 6;

#[test]
fn what_is_finished_is_not_measured_again() {
    let folder = tempfile::tempdir().unwrap();
    let first = swept(folder.path(), &options());
    assert_eq!(first.skipped, 0);
    let again = swept(folder.path(), &options());
    assert_eq!(again.skipped, CASES);
    // To the last bit, times too: nothing was measured.
    assert!(again.results == first.results, "not the same figures");

    let case = folder.path().join("cases/spikes-cpu-5-4.json");
    fs::remove_file(&case).unwrap();
    let picture = folder.path().join(&first.results.pictures[0].picture);
    fs::remove_file(&picture).unwrap();
    let mended = swept(folder.path(), &options());
    assert_eq!(mended.skipped, CASES - 2);
    assert!(case.is_file() && picture.is_file());
    assert_eq!(timeless(mended.results), timeless(first.results.clone()));

    // Other settings are another question; what they do not touch stays.
    let more = SweepOptions { rays: 512, ..options() };
    assert_eq!(swept(folder.path(), &more).skipped, 4);
    // Another map of the same name is another map.
    let other = [TestMaterial::of_heights("spikes", corpus("noise", 64).unwrap())];
    let swept = sweep(&other, &more, &mut [MarchBackend::Cpu], folder.path(), None).unwrap();
    assert_eq!(swept.skipped, 0);
}

#[test]
fn all_figures_but_times_and_all_pictures_are_the_same_with_one_thread_and_with_many() {
    let run = |threads: usize| {
        let folder = tempfile::tempdir().unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let results = timeless(pool.install(|| swept(folder.path(), &options())).results);
        let pictures: Vec<Vec<u8>> = (results.pictures.iter())
            .flat_map(|row| [Some(&row.picture), Some(&row.truth), row.hits.as_ref()].into_iter().flatten())
            .map(|file| fs::read(folder.path().join(file)).unwrap())
            .collect();
        write_report(folder.path(), &results, 1 << 20).unwrap();
        let page = fs::read(folder.path().join("report.html")).unwrap();
        (results, pictures, page)
    };
    let (one, many) = (run(1), run(5));
    assert_eq!(one.0, many.0);
    assert!(one.1 == many.1 && one.2 == many.2, "pictures or page differ");
}

#[test]
fn figures_say_what_is_known_of_these_materials() {
    let folder = tempfile::tempdir().unwrap();
    let results = swept(folder.path(), &options()).results;
    assert_eq!(results.hits.len(), 2 * 2 * 2 * 3 * techniques().len());
    let rows = |technique: &'static str| results.hits.iter().filter(move |row| row.technique == technique);
    for row in rows("exact").chain(rows("exact:cells")) {
        assert_eq!((row.hits.wrong, row.hits.false_skips, row.hits.false_stops), (0.0, 0.0, 0.0), "{row:?}");
        assert!((row.samples, row.hits.misses) == (0.0, 0.0) && row.ns_per_ray > 0.0, "{row:?}");
    }
    for (exact, cells) in rows("exact").zip(rows("exact:cells")) {
        assert!(cells.nodes == 0.0 && exact.nodes >= 1.0 && exact.gathers <= cells.gathers, "{exact:?} {cells:?}");
        assert_eq!(exact.hits.texels, cells.hits.texels);
        assert!(exact.bytes > cells.bytes);
    }
    assert!(rows("occlusion:8..32").any(|row| row.hits.false_skips > 0.05 && row.samples > 5.0));
    assert!(rows("normal").all(|row| row.hits.fetches.max == 0.0 && row.hits.divergence == 1.0));
    // Straight down the depth does not matter, and no step can be too long.
    assert!(rows("occlusion:8..32").filter(|row| row.angle == 0.0).all(|row| row.hits.wrong == 0.0));

    let flip = |material: &str, technique: &str| {
        let of = |row: &&PictureRow| {
            (row.material.as_str(), row.technique.as_str(), row.minification) == (material, technique, 1)
        };
        results.pictures.iter().find(of).unwrap().flip
    };
    assert!(flip("toy-box", "exact") < 0.05 && flip("toy-box", "normal") > 0.3);
    // Between vertices displaced geometry is flat, which needles show; still the layers are seen.
    assert!(flip("spikes", "exact") < 0.7 * flip("spikes", "occlusion:8..32"));
    assert!(results.pictures.iter().any(|row| row.lod));
}

#[test]
fn reports_are_well_formed_and_need_no_other_file() {
    let folder = tempfile::tempdir().unwrap();
    let results = swept(folder.path(), &options()).results;
    write_report(folder.path(), &results, 1 << 20).unwrap();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();

    let page = read("report.html");
    let parsing = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    let document = roxmltree::Document::parse_with_options(&page, parsing).unwrap();
    for node in document.descendants() {
        for name in ["src", "href"] {
            let value = node.attribute(name).unwrap_or("data:");
            assert!(value.starts_with("data:"), "{value}");
        }
    }
    assert!(!page.contains("://") && !page.contains("@import") && !page.contains("url("));
    let count = |tag: &str| document.descendants().filter(|node| node.has_tag_name(tag)).count();
    // Over all materials, and of each: two curves by fetches, one by time.
    assert_eq!((count("details"), count("svg")), (2, 4 + 2 * 3));
    assert!(count("img") > 10, "{}", count("img"));
    for word in ["spikes", "toy-box", "false_skips", &results.machine.cpu] {
        assert!(page.contains(word), "{word}");
    }

    assert_eq!(serde_json::from_str::<Results>(&read("results.json")).unwrap(), results);
    let lines = read("hits.csv").lines().count();
    assert_eq!(lines, 1 + results.hits.len());
    assert!(read("hits.csv").lines().all(|line| line.split(',').count() == 40), "{}", read("hits.csv"));
    assert_eq!(read("pictures.csv").lines().count(), 1 + results.pictures.len());
    let summary = read("summary.md");
    assert!(summary.contains("`exact` was wrong on 0 of 3072 rays") && summary.contains("| spikes |"), "{summary}");

    // Pictures that do not fit stay beside the page.
    write_report(folder.path(), &results, 1).unwrap();
    assert!(!read("report.html").contains("<img"));
    assert!(read("report.html").contains("4 more views"));
}

#[test]
fn what_cannot_be_measured_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("new");
    let refused = |materials: &[TestMaterial], options: &SweepOptions| {
        let error = sweep(materials, options, &mut [MarchBackend::Cpu], &inside, None).unwrap_err();
        assert!(!inside.exists());
        error.to_string()
    };
    for options in [
        SweepOptions { angles: vec![90.0], ..options() },
        SweepOptions { angles: vec![f32::NAN], ..options() },
        SweepOptions { depths: vec![-1.0], ..options() },
        SweepOptions { minifications: vec![3], ..options() },
        SweepOptions { techniques: Vec::new(), ..options() },
        SweepOptions { rays: 0, ..options() },
    ] {
        refused(&materials(), &options);
    }
    let twins = [materials().swap_remove(0), materials().swap_remove(0)];
    assert!(refused(&twins, &options()).contains("two materials are called spikes"));
    fs::write(folder.path().join("file"), "").unwrap();
    let at = |name: &str| sweep(&materials(), &options(), &mut [MarchBackend::Cpu], &folder.path().join(name), None);
    assert!(matches!(at("file"), Err(LabError::Folder { .. })));
    assert!(matches!(at("no/such"), Err(LabError::Folder { .. })));
    fs::create_dir(folder.path().join("odd")).unwrap();
    fs::write(folder.path().join("odd/relievo-manifest.json"), "hello").unwrap();
    assert!(matches!(at("odd"), Err(LabError::Journal(JournalError::NotAJournal { .. }))));
}
