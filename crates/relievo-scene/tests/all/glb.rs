//! A small writer of GLB files for tests.

/// Collects binary data and the views and accessors over it.
#[derive(Default)]
pub(crate) struct Glb {
    bin: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Glb {
    /// Bytes as a view of their own; returns its index.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let (offset, length) = (self.bin.len(), bytes.len());
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#));
        self.bin.extend_from_slice(bytes);
        self.views.len() - 1
    }

    /// Vectors as an accessor; returns its index.
    pub(crate) fn vectors<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(view, 5126, values.len(), &format!("VEC{N}"), "")
    }

    /// Indices as an accessor; returns its index.
    pub(crate) fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(view, 5123, values.len(), "SCALAR", "")
    }

    pub(crate) fn accessor(&mut self, view: usize, component: u32, count: usize, kind: &str, more: &str) -> usize {
        self.accessors.push(format!(
            r#"{{"bufferView":{view},"componentType":{component},"count":{count},"type":"{kind}"{more}}}"#
        ));
        self.accessors.len() - 1
    }

    /// The file; `rest` are the members of the JSON besides asset, buffers, views and accessors.
    pub(crate) fn finish(&self, rest: &str) -> Vec<u8> {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],"bufferViews":[{}],"accessors":[{}],{rest}}}"#,
            self.bin.len(),
            self.views.join(","),
            self.accessors.join(",")
        );
        container(json.as_bytes(), &self.bin)
    }
}

/// A GLB container around a JSON and a binary chunk.
pub(crate) fn container(json: &[u8], bin: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let mut chunks = Vec::new();
    for (kind, bytes) in [(b"JSON", padded(json, b' ')), (b"BIN\0", padded(bin, 0))] {
        chunks.extend((bytes.len() as u32).to_le_bytes());
        chunks.extend(kind);
        chunks.extend(bytes);
    }
    let mut file = b"glTF".to_vec();
    file.extend(2u32.to_le_bytes());
    file.extend((12 + chunks.len() as u32).to_le_bytes());
    file.extend(chunks);
    file
}

pub(crate) const SQUARE: [[f32; 3]; 4] = [[-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0]];
pub(crate) const SQUARE_UVS: [[f32; 2]; 4] = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];

/// A square with texture coordinates; its primitive has `more` members, the JSON has `rest`.
pub(crate) fn square(more: &str, rest: &str) -> Vec<u8> {
    let mut glb = Glb::default();
    let positions = glb.vectors(&SQUARE);
    let uvs = glb.vectors(&SQUARE_UVS);
    let normals = glb.vectors(&[[0.0f32, 0.0, 2.0]; 4]);
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    glb.finish(&format!(
        r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals},"TEXCOORD_0":{uvs}}},
        "indices":{indices}{more}}}]}}],{rest}"#
    ))
}

/// One node drawing mesh 0.
pub(crate) const ONE_NODE: &str = r#""nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0"#;

/// A PNG of one colour.
pub(crate) fn png(color: [u8; 3]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbImage::from_pixel(2, 2, image::Rgb(color));
    picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}
