//! A journal from outside: what is finished, what is kept for others, and files of other versions.

use std::fs;
use std::path::Path;

use relievo_journal::{ContentHash, Input, Journal, JournalError, Work};
use serde::Serialize;
use serde_json::{Value, json};
use tempfile::TempDir;

#[derive(Serialize)]
struct Options {
    radius: f32,
    format: Option<&'static str>,
    #[serde(skip)]
    #[expect(dead_code, reason = "changes no result, so nothing may read it")]
    threads: u32,
}

const OPTIONS: Options = Options { radius: 0.05, format: None, threads: 1 };

fn work(options: &Options) -> Work {
    Work::new("0.1.0", options).unwrap()
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    ["a.png", "b.png"].iter().for_each(|name| fs::write(folder.path().join(name), name).unwrap());
    folder
}

/// Finishes `work` under `name`, with one output.
#[track_caller]
fn finish(folder: &Path, kind: &str, name: &str, work: Work, output: &str) {
    let mut journal = Journal::open(folder, kind).unwrap();
    journal.begin(name).unwrap();
    journal.finish(name, work, vec![output.to_owned()]).unwrap();
}

fn is_finished(folder: &Path, kind: &str, name: &str, work: &Work) -> bool {
    Journal::open(folder, kind).unwrap().finished(name, work).is_some()
}

fn json(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join(Journal::FILE_NAME)).unwrap()).unwrap()
}

fn write(folder: &Path, text: impl AsRef<[u8]>) {
    fs::write(folder.join(Journal::FILE_NAME), text).unwrap();
}

#[test]
fn work_is_finished_while_options_version_inputs_and_outputs_are_the_same() {
    let folder = folder();
    let folder = folder.path();
    let input = || Input::of_file(&folder.join("b.png")).unwrap();
    let of = |options: &Options| work(options).reading(input());
    assert!(!is_finished(folder, "map", "ao/a", &of(&OPTIONS)));
    finish(folder, "map", "ao/a", of(&OPTIONS), "a.png");
    assert!(is_finished(folder, "map", "ao/a", &of(&OPTIONS)));
    assert!(is_finished(folder, "map", "ao/a", &of(&Options { threads: 8, ..OPTIONS })));

    assert!(!is_finished(folder, "map", "ao/b", &of(&OPTIONS)));
    assert!(!is_finished(folder, "map", "ao/a", &of(&Options { radius: 0.050_000_004, ..OPTIONS })));
    assert!(!is_finished(folder, "map", "ao/a", &of(&Options { format: Some("exr"), ..OPTIONS })));
    assert!(!is_finished(folder, "map", "ao/a", &Work::new("0.2.0", &OPTIONS).unwrap().reading(input())));
    assert!(!is_finished(folder, "map", "ao/a", &work(&OPTIONS)));
    let hash = ContentHash::of(b"strokes");
    assert!(!is_finished(folder, "map", "ao/a", &of(&OPTIONS).reading(Input::of_content("strokes", hash))));

    let before = of(&OPTIONS);
    fs::write(folder.join("b.png"), "longer than it was").unwrap();
    assert!(!is_finished(folder, "map", "ao/a", &of(&OPTIONS)));
    assert!(is_finished(folder, "map", "ao/a", &before));
    fs::remove_file(folder.join("a.png")).unwrap();
    assert!(!is_finished(folder, "map", "ao/a", &before));
    assert!(matches!(Input::of_file(&folder.join("a.png")), Err(JournalError::Input { .. })));
}

#[test]
fn what_is_begun_is_not_finished() {
    let folder = folder();
    finish(folder.path(), "map", "ao/a", work(&OPTIONS), "a.png");
    let mut journal = Journal::open(folder.path(), "map").unwrap();
    journal.begin("ao/a").unwrap();
    assert!(!is_finished(folder.path(), "map", "ao/a", &work(&OPTIONS)));
    // Nothing is known of this name, so there is nothing to write.
    fs::remove_file(journal.path()).unwrap();
    journal.begin("ao/b").unwrap();
    assert!(!journal.path().exists());
}

#[test]
fn an_output_that_is_written_over_belongs_to_the_later_work_alone() {
    let folder = folder();
    finish(folder.path(), "map", "edit/a", work(&OPTIONS), "a.png");
    finish(folder.path(), "map", "edit/b", work(&OPTIONS), "b.png");
    finish(folder.path(), "map", "paint/a", work(&OPTIONS), "a.png");
    let is_finished = |name: &str| is_finished(folder.path(), "map", name, &work(&OPTIONS));
    assert_eq!([is_finished("edit/a"), is_finished("edit/b"), is_finished("paint/a")], [false, true, true]);
}

#[test]
fn kinds_live_together_also_when_two_processes_write() {
    let folder = folder();
    let folder = folder.path();
    let mut map = Journal::open(folder, "map").unwrap();
    let mut lab = Journal::open(folder, "lab").unwrap();
    let mut other_map = Journal::open(folder, "map").unwrap();
    let finish = |journal: &mut Journal, name| journal.finish(name, work(&OPTIONS), Vec::new()).unwrap();
    finish(&mut map, "1");
    finish(&mut lab, "1");
    finish(&mut other_map, "2");
    finish(&mut map, "3");
    for (kind, name) in [("map", "1"), ("lab", "1"), ("map", "2"), ("map", "3")] {
        assert!(is_finished(folder, kind, name, &work(&OPTIONS)), "{kind} {name}");
    }
    assert!(!is_finished(folder, "lab", "2", &work(&OPTIONS)));
}

#[test]
fn what_a_later_version_adds_is_kept() {
    let folder = folder();
    let strange = json!([{ "colour": "blue" }, 3, null]);
    write(folder.path(), json!({ "version": 1, "kinds": { "export": strange }, "made by": "us" }).to_string());
    finish(folder.path(), "map", "ao/a", work(&OPTIONS), "a.png");
    let file = json(folder.path());
    assert_eq!(file["kinds"]["export"], strange);
    assert_eq!(file["made by"], "us");
    assert_eq!(file["version"], 1);
    // A reader sees what was done with which options.
    assert_eq!(file["kinds"]["map"]["ao/a"]["options"], json!({ "radius": 0.05, "format": null }));
    assert_eq!(file["kinds"]["map"]["ao/a"]["outputs"], json!(["a.png"]));
}

#[test]
fn files_without_a_version_are_recognised_and_everything_is_done_again() {
    let old_map = json!({ "bricks": { "command": "ao radius=0.1", "input": "in/b.png", "bytes": 3, "changed": 4, "outputs": ["a.png"] } });
    let old_lab = json!({ "spikes-cpu-5-4": "relievo 0.1.0, maps 0123456789abcdef, on CPU with 2 threads" });
    for old in [old_map, old_lab] {
        for kind in ["map", "lab"] {
            let folder = folder();
            write(folder.path(), old.to_string());
            let journal = Journal::open(folder.path(), kind).unwrap();
            assert!(journal.note().unwrap().contains("an earlier version of Relievo; everything is done again"));
            assert!(journal.finished("bricks", &work(&OPTIONS)).is_none());
            finish(folder.path(), kind, "bricks", work(&OPTIONS), "a.png");
            assert!(is_finished(folder.path(), kind, "bricks", &work(&OPTIONS)));
            assert!(Journal::open(folder.path(), kind).unwrap().note().is_none());
        }
    }
}

#[test]
fn a_later_format_is_refused_with_what_to_do() {
    let folder = folder();
    let text = json!({ "version": 2, "kinds": 7 }).to_string();
    write(folder.path(), &text);
    let error = Journal::open(folder.path(), "map").unwrap_err();
    assert!(matches!(error, JournalError::NewerFormat { version: 2, .. }), "{error:?}");
    for words in
        [Journal::FILE_NAME, "a later version of Relievo", "use that version", "another folder", "move the file"]
    {
        assert!(error.to_string().contains(words), "{error}");
    }
    assert_eq!(fs::read_to_string(folder.path().join(Journal::FILE_NAME)).unwrap(), text);
}

#[test]
fn what_is_no_journal_is_refused_and_left_alone() {
    for text in
        ["", "hello", "{", "[]", "3", r#"{"name": 3}"#, r#"{"version": 1}"#, r#"{"version": 1, "kinds": {"map": 3}}"#]
    {
        let folder = folder();
        write(folder.path(), text);
        let error = Journal::open(folder.path(), "map").unwrap_err();
        assert!(matches!(error, JournalError::NotAJournal { .. }), "{text}: {error:?}");
        assert!(
            error.to_string().contains("this is no manifest of Relievo") && error.to_string().contains("move it away")
        );
        assert_eq!(fs::read_to_string(folder.path().join(Journal::FILE_NAME)).unwrap(), text);
    }
    let folder = folder();
    fs::create_dir(folder.path().join(Journal::FILE_NAME)).unwrap();
    assert!(matches!(Journal::open(folder.path(), "map"), Err(JournalError::Unreadable { .. })));
}
