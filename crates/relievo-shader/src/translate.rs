//! WGSL as the other shading languages, by naga.

use std::error::Error;
use std::fmt::{self, Display, Formatter};

use naga::back::{glsl, hlsl, msl, spv};
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// A valid WGSL shader, to be written in another language.
///
/// It may use no capability beyond what WebGL2 has.
#[derive(Clone, Debug)]
pub struct WgslModule {
    module: naga::Module,
    info: ModuleInfo,
}

/// A version of GLSL.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum GlslVersion {
    /// GLSL ES 3.00: WebGL2, OpenGL ES 3.0. Has no compute shaders.
    Es300,
    /// GLSL ES 3.10: OpenGL ES 3.1.
    Es310,
    /// GLSL 3.30: OpenGL 3.3. Has no compute shaders.
    Core330,
    /// GLSL 4.30: OpenGL 4.3.
    Core430,
}

/// A shader that cannot be translated.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TranslateError {
    /// The text is not WGSL. Holds naga's message, with the line.
    Parse(String),
    /// The shader is not valid. Holds naga's message, with the line.
    Invalid(String),
    /// The shader has no entry point of this name.
    NoEntryPoint(String),
    /// The shader uses what the language cannot say.
    Unsupported {
        /// The language.
        language: &'static str,
        /// The message of naga.
        message: String,
    },
}

impl Display for TranslateError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parse(message) => write!(f, "the shader is not WGSL: {message}"),
            Self::Invalid(message) => write!(f, "the shader is not valid: {message}"),
            Self::NoEntryPoint(name) => write!(f, "the shader has no entry point \"{name}\""),
            Self::Unsupported { language, message } => write!(f, "{language} cannot say this shader: {message}"),
        }
    }
}

impl Error for TranslateError {}

impl WgslModule {
    /// Parses and validates a WGSL shader.
    ///
    /// # Errors
    /// If the text is no WGSL, or not valid.
    pub fn parse(wgsl: &str) -> Result<Self, TranslateError> {
        let module =
            naga::front::wgsl::parse_str(wgsl).map_err(|error| TranslateError::Parse(error.emit_to_string(wgsl)))?;
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .map_err(|error| TranslateError::Invalid(error.emit_to_string(wgsl)))?;
        Ok(Self { module, info })
    }

    /// Names of the entry points.
    pub fn entry_points(&self) -> impl Iterator<Item = &str> {
        self.module.entry_points.iter().map(|entry| entry.name.as_str())
    }

    /// Writes one entry point in GLSL, with all it calls.
    ///
    /// # Errors
    /// If there is no such entry point, or the version lacks what it uses.
    pub fn glsl(&self, entry_point: &str, version: GlslVersion) -> Result<String, TranslateError> {
        let entry = self.module.entry_points.iter().find(|entry| entry.name == entry_point);
        let stage = entry.ok_or_else(|| TranslateError::NoEntryPoint(entry_point.to_owned()))?.stage;
        let version = match version {
            GlslVersion::Es300 => glsl::Version::Embedded { version: 300, is_webgl: true },
            GlslVersion::Es310 => glsl::Version::Embedded { version: 310, is_webgl: false },
            GlslVersion::Core330 => glsl::Version::Desktop(330),
            GlslVersion::Core430 => glsl::Version::Desktop(430),
        };
        let options = glsl::Options { version, ..glsl::Options::default() };
        let pipeline =
            glsl::PipelineOptions { shader_stage: stage, entry_point: entry_point.to_owned(), multiview: None };
        let mut text = String::new();
        let policies = BoundsCheckPolicies::default();
        glsl::Writer::new(&mut text, &self.module, &self.info, &options, &pipeline, policies)
            .and_then(|mut writer| writer.write().map(drop))
            .map_err(|error| unsupported("GLSL", &error))?;
        Ok(text)
    }

    /// Writes the shader in HLSL, shader model 5.1.
    ///
    /// # Errors
    /// If HLSL lacks what it uses.
    pub fn hlsl(&self) -> Result<String, TranslateError> {
        let (options, pipeline) = (hlsl::Options::default(), hlsl::PipelineOptions::default());
        let mut text = String::new();
        hlsl::Writer::new(&mut text, &options, &pipeline)
            .write(&self.module, &self.info, None)
            .map_err(|error| unsupported("HLSL", &error))?;
        Ok(text)
    }

    /// Writes the shader in the Metal Shading Language, of this version (major, minor).
    ///
    /// # Errors
    /// If that version lacks what it uses.
    pub fn msl(&self, version: (u8, u8)) -> Result<String, TranslateError> {
        let options = msl::Options { lang_version: version, ..msl::Options::default() };
        let pipeline = msl::PipelineOptions::default();
        let written = msl::write_string(&self.module, &self.info, &options, &pipeline);
        Ok(written.map_err(|error| unsupported("MSL", &error))?.0)
    }

    /// Writes the shader in SPIR-V 1.1, as words.
    ///
    /// # Errors
    /// If SPIR-V lacks what it uses.
    pub fn spirv(&self) -> Result<Vec<u32>, TranslateError> {
        let options = spv::Options { lang_version: (1, 1), ..spv::Options::default() };
        spv::write_vec(&self.module, &self.info, &options, None).map_err(|error| unsupported("SPIR-V", &error))
    }
}

fn unsupported(language: &'static str, error: &dyn Display) -> TranslateError {
    TranslateError::Unsupported { language, message: error.to_string() }
}
