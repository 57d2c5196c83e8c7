//! A temporary folder, the program in it, and scenes to feed it.

use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

use etendue::image::Image;
use etendue::io::images::read_image;
use tempfile::TempDir;

/// A temporary folder to run the program in.
pub(crate) struct Folder {
    folder: TempDir,
}

impl Folder {
    pub(crate) fn new() -> Self {
        Self { folder: TempDir::new().expect("there is room for temporary files") }
    }

    /// A folder with `scene.pbrt`.
    pub(crate) fn with_scene(text: &str) -> Self {
        let folder = Self::new();
        folder.write("scene.pbrt", text);
        folder
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).expect("the file can be written");
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub(crate) fn image(&self, name: &str) -> Image {
        read_image(self.path(name)).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Names of all files, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).expect("the folder is there");
        let name = |entry: std::io::Result<std::fs::DirEntry>| {
            entry.expect("the folder can be read").file_name().to_string_lossy().into_owned()
        };
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }

    /// The program, ready to start here with these arguments.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_etendue"));
        command.args(arguments).current_dir(self.folder.path()).stdin(Stdio::null());
        command
    }

    /// Runs the program with arguments separated by blanks.
    pub(crate) fn run(&self, arguments: &str) -> Run {
        self.run_with(&arguments.split_whitespace().collect::<Vec<_>>())
    }

    pub(crate) fn run_with(&self, arguments: &[&str]) -> Run {
        let output = self.command(arguments).output().expect("the program starts");
        Run {
            arguments: arguments.join(" "),
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).expect("standard output is text"),
            stderr: String::from_utf8(output.stderr).expect("standard error is text"),
        }
    }

    /// Starts the program with arguments separated by blanks.
    pub(crate) fn start(&self, arguments: &str) -> Child {
        let arguments: Vec<&str> = arguments.split_whitespace().collect();
        let mut command = self.command(&arguments);
        command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts")
    }

    /// Renders `scene.pbrt` to `NAME.exr` with more arguments, successfully.
    #[track_caller]
    pub(crate) fn render(&self, name: &str, arguments: &str) -> Image {
        self.run(&format!("render scene.pbrt -q -o {name}.exr {arguments}")).expect(0);
        self.image(&format!("{name}.exr"))
    }
}

/// What came of a run.
#[derive(Debug)]
pub(crate) struct Run {
    arguments: String,
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    /// Demands an exit code; a panic of the program is a failure whatever its code, and so are colours in a pipe.
    #[track_caller]
    pub(crate) fn expect(self, code: i32) -> Self {
        let Self { arguments, stdout, stderr, .. } = &self;
        let all = format!("etendue {arguments}\n{stdout}\n{stderr}");
        assert_eq!(self.code, Some(code), "{all}");
        assert!(!stderr.contains("panicked"), "{all}");
        assert!(!stderr.contains('\u{1b}') && !stdout.contains('\u{1b}'), "{all}");
        self
    }

    /// Demands a text on standard error.
    #[track_caller]
    pub(crate) fn says(self, text: &str) -> Self {
        assert!(self.stderr.contains(text), "'{text}' is missing in\n{}", self.stderr);
        self
    }

    /// Standard output as one JSON object and nothing else.
    #[track_caller]
    pub(crate) fn json(&self) -> serde_json::Value {
        let value: serde_json::Value =
            serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}:\n{}", self.stdout));
        assert!(value.is_object(), "{value}");
        assert_eq!(self.stdout.trim().lines().count(), 1, "{}", self.stdout);
        value
    }
}

/// A small scene with these directives before and after `WorldBegin`; it has a lamp and a camera that looks along z.
pub(crate) fn scene(options: &str, world: &str) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6\n\
         Sampler \"independent\" \"integer pixelsamples\" 1\n\
         Camera \"perspective\"\n\
         {options}\n\
         WorldBegin\n\
         LightSource \"point\" \"rgb I\" [ 10 10 10 ]\n\
         {world}\n"
    )
}

/// The same without the lamp.
pub(crate) fn unlit_scene(options: &str, world: &str) -> String {
    let lamp = "LightSource \"point\" \"rgb I\" [ 10 10 10 ]";
    let text = scene(options, world);
    assert!(text.contains(lamp));
    text.replace(lamp, "")
}

/// Lines before the first line of `world` in [`scene`].
pub(crate) const WORLD_LINE: usize = 7;

/// A scene with soft shadows, two bounces and some noise, of 40 x 24 pixels.
pub(crate) const ROOM: &str = r#"
LookAt 0 1 -4  0 1 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 40 "integer yresolution" 24 "string filename" "room.exr"
Sampler "zsobol" "integer pixelsamples" 4
Integrator "path" "integer maxdepth" 4
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 5 5 5 ]
  Translate 0 2.5 0
  Rotate 90 1 0 0
  Shape "disk" "float radius" 0.5
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.4 0.2 ]
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]
Material "dielectric"
AttributeBegin
  Translate 0.4 0.5 0
  Shape "sphere" "float radius" 0.5
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.3 0.5 0.8 ]
Translate -0.6 0.6 0.5
Shape "sphere" "float radius" 0.6
"#;

/// Names of the channels that differ in any bit, and of those that only one image has.
pub(crate) fn differing_channels(a: &Image, b: &Image) -> Vec<String> {
    let bits = |image: &Image, name: &str| -> Option<Vec<u32>> {
        Some(image.channel(name)?.values.iter().map(|v| v.to_bits()).collect())
    };
    let names = a.channels.iter().chain(&b.channels).map(|channel| channel.name.clone());
    let mut names: Vec<String> = names.filter(|name| bits(a, name) != bits(b, name)).collect();
    names.sort();
    names.dedup();
    names
}

/// Demands that two images have the same channels with the same bits.
#[track_caller]
pub(crate) fn assert_same(a: &Image, b: &Image) {
    assert_eq!((a.width, a.height), (b.width, b.height));
    assert_eq!(differing_channels(a, b), Vec::<String>::new());
}

/// Mean of all colour values.
pub(crate) fn mean(image: &Image) -> f64 {
    let pixels = image.rgb_pixels().expect("the image has a colour");
    let sum: f64 = pixels.iter().flatten().map(|v| f64::from(*v)).sum();
    sum / (3 * pixels.len()) as f64
}

/// True where slow tests shall run too.
pub(crate) fn is_slow() -> bool {
    std::env::var_os("ETENDUE_SLOW").is_some()
}

/// Programs that run and are told to end.
#[cfg(unix)]
pub(crate) mod signals {
    use std::path::Path;
    use std::process::{Child, Command};
    use std::time::{Duration, Instant};

    /// Longer than anything takes, even on a busy machine.
    const PATIENCE: Duration = Duration::from_secs(120);

    /// Waits for something.
    #[track_caller]
    fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
        let begun = Instant::now();
        while !is_so() {
            assert!(begun.elapsed() < PATIENCE, "{what}");
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Waits for a file to appear.
    #[track_caller]
    pub(crate) fn wait_for(path: &Path) {
        wait_until(&format!("{} does not appear", path.display()), || path.exists());
    }

    /// Waits until the program catches Ctrl-C, as Linux tells.
    #[cfg(target_os = "linux")]
    #[track_caller]
    pub(crate) fn wait_for_handler(child: &Child) {
        let status = format!("/proc/{}/status", child.id());
        wait_until("the program does not catch signals", || {
            let text = std::fs::read_to_string(&status).expect("the program runs");
            let caught = text.lines().find_map(|line| line.strip_prefix("SigCgt:")).expect("a mask");
            u64::from_str_radix(caught.trim(), 16).expect("a number") & 0b10 != 0
        });
    }

    /// Sends a signal as a terminal would.
    #[track_caller]
    pub(crate) fn send(child: &Child, signal: &str) {
        let id = child.id().to_string();
        assert!(Command::new("kill").args([signal, &id]).status().expect("kill runs").success());
    }

    /// Waits for the end: the exit code and what was said.
    #[track_caller]
    pub(crate) fn end(mut child: Child) -> (Option<i32>, String) {
        wait_until("the program does not end", || child.try_wait().expect("it can be asked").is_some());
        let output = child.wait_with_output().expect("it has ended");
        (output.status.code(), String::from_utf8(output.stderr).expect("text"))
    }
}
