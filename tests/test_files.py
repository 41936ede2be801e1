"""Files are plain ones where it matters, and nothing outside a folder is read or written."""

import errno
import multiprocessing
import os
import shutil
import socket
import sqlite3
import struct

import pytest

from rotctl import files
from rotctl.errors import InputError
from rotctl.files import replacement
from rotctl.tune.history import open_history
from rotctl.tune.space import load_space

NOT_PLAIN = "is no plain file"
pytestmark = pytest.mark.usefixtures("here_alone")


@pytest.fixture
def victim(tmp_path):
    """A file outside of the folder that is written into."""
    path = tmp_path / "victim"
    path.write_text("precious")
    return path


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "folder"
    path.mkdir()
    return path


def refused(path, **settings):
    with pytest.raises(InputError) as caught:
        files.read(path, 10, **{"linked": False, **settings})
    return str(caught.value).removeprefix(f"{path}: ")


# ---------------------------------------------------------------- reading


def test_what_is_no_plain_file_is_refused_at_once(folder, victim):
    os.mkfifo(folder / "pipe")
    (folder / "inner").mkdir()
    (folder / "link").symlink_to(victim)
    (folder / "dangling").symlink_to(folder / "nothing")
    (folder / "circle").symlink_to(folder / "circle")
    with socket.socket(socket.AF_UNIX) as bound:
        bound.bind(str(folder / "socket"))
        assert refused(folder / "socket") == NOT_PLAIN
    assert refused(folder / "pipe") == NOT_PLAIN
    assert refused("/dev/zero") == NOT_PLAIN
    assert refused(folder / "inner") == "is a folder"
    assert refused(folder / "link") == "is a link; only plain files are read here"
    assert refused(folder / "dangling") == "is a link; only plain files are read here"
    assert refused(folder / "dangling", linked=True) == "no such file"
    assert refused(folder / "circle", linked=True) == "Too many levels of symbolic links"
    for name in ("nothing", "x" * 300, "nul\0", "link/x", "\ud800"):
        assert refused(folder / name) == "no such file"
    assert files.read(folder / "link", 10, linked=True) == b"precious"


def test_a_link_to_a_pipe_is_no_way_around(folder):
    os.mkfifo(folder / "pipe")
    (folder / "link").symlink_to(folder / "pipe")
    assert refused(folder / "link", linked=True) == NOT_PLAIN


def test_no_more_than_the_limit_is_read(folder):
    (folder / "a").write_bytes(b"0123456789")
    assert files.read(folder / "a", 10, linked=False) == b"0123456789"
    (folder / "a").write_bytes(b"0123456789\n")
    assert refused(folder / "a") == "larger than 1e-05 MB"


def test_text_is_utf8(folder):
    (folder / "a").write_bytes("\ufeffä".encode())
    assert files.text(folder / "a", 10, linked=False) == "ä"
    (folder / "a").write_bytes(b"\n\n\xff")
    with pytest.raises(InputError) as caught:
        files.text(folder / "a", 10, linked=False)
    assert str(caught.value) == f"{folder / 'a'}:3: is no text (UTF-8)"


# ---------------------------------------------------------------- writing


def test_links_are_replaced_not_followed(folder, victim):
    (folder / "a").symlink_to(victim)
    (folder / "a.part").symlink_to(victim)
    files.replace(folder / "a", b"new", durable=True)
    assert (folder / "a").read_bytes() == b"new"
    assert not (folder / "a").is_symlink()
    assert os.listdir(folder) == ["a"]
    assert victim.read_text() == "precious"


def test_a_part_that_a_kill_left_is_no_obstacle(folder):
    (folder / "a.part").write_text("half")
    files.replace(folder / "a", b"new")
    assert os.listdir(folder) == ["a"]


def test_what_was_there_stays_where_writing_fails(folder):
    (folder / "a").write_text("old")
    with (
        pytest.raises(InputError, match=r"a: No space left on device$"),
        files.replacing(folder / "a"),
    ):
        raise OSError(28, os.strerror(28))
    (folder / "b.part").mkdir()
    with pytest.raises(InputError, match=r"^cannot write .*/b: "):
        files.replace(folder / "b", b"new")
    assert (folder / "a").read_text() == "old"
    assert sorted(os.listdir(folder)) == ["a", "b.part"]


def test_an_interrupt_leaves_nothing(folder, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        files.replace(folder / "a", b"new")
    with pytest.raises(KeyboardInterrupt), files.replacing(folder / "a"):
        raise KeyboardInterrupt
    assert os.listdir(folder) == []


def test_two_that_write_the_same_file_at_once_each_put_a_whole_one(folder):
    contents = [letter * 300_000 for letter in (b"a", b"b", b"c")]

    def writes(content):
        for _ in range(60):
            files.replace(folder / "a", content)

    writers = [
        multiprocessing.get_context("fork").Process(target=writes, args=(c,)) for c in contents
    ]
    for writer in writers:
        writer.start()
    while any(writer.is_alive() for writer in writers):
        if (folder / "a").exists():
            assert (folder / "a").read_bytes() in contents
    assert [writer.exitcode for writer in writers] == [0, 0, 0]
    assert os.listdir(folder) == ["a"]


def test_without_locks_nobody_publishes_what_another_has_half_written(folder, monkeypatch):
    """Which had one take away the other's file, and that one then put half of the first's there."""

    def none(file, how):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("fcntl.flock", none)
    (folder / "b.part").write_text("left by a kill")
    for name in ("a", "b"):
        path = folder / name
        with files.replacing(path) as first:
            first.write_text("first, ")
            with files.replacing(path) as second:
                second.write_text("half")
                with first.open("a") as more:
                    more.write("whole")
                assert {first.name, second.name} <= set(os.listdir(folder))
            assert path.read_text() == "half"
        assert path.read_text() == "first, whole"
    assert sorted(os.listdir(folder)) == ["a", "b", "b.part"]


def test_the_part_of_a_third_one_stays_where_that_of_the_second_took_its_place(folder, monkeypatch):
    part = folder / "a.part"

    def gone_and_another_begun(path, flags):
        part.write_bytes(b"another's")
        raise FileNotFoundError(path)

    monkeypatch.setattr(os, "open", gone_and_another_begun)
    replacement._removed(part)
    assert part.read_bytes() == b"another's"


def test_a_folder_that_stays_empty_goes_again(folder):
    with files.folder(folder / "a" / "b", linked=False):
        pass
    assert (folder / "a" / "b").is_dir()
    with pytest.raises(KeyError), files.folder(folder / "a" / "c" / "d", linked=False):
        raise KeyError
    assert os.listdir(folder / "a") == ["b"]
    with pytest.raises(FileNotFoundError), files.folder(folder / "e" / "f", linked=False):
        shutil.move(folder / "nothing", shutil.move(folder / "a" / "b", folder / "e"))
    assert os.listdir(folder / "e") == ["b"]


def test_a_name_that_no_folder_may_have_is_told_with_its_reason(folder):
    path = folder / ("x" * 300) / "a"
    said = f"cannot write {path}: File name too long"
    with pytest.raises(InputError) as error, files.folder(path, linked=True):
        pass
    assert str(error.value) == said
    with pytest.raises(InputError) as error:
        files.replace(path, b"")
    assert str(error.value) == said


@pytest.mark.parametrize("to", ["nowhere", "link"])
def test_a_link_to_nothing_is_told_as_one(folder, to):
    link = folder / "link"
    link.symlink_to(to)
    said = f"{link} is a link to what is not there"
    for path in (link, link / "a" / "b"):
        with pytest.raises(InputError) as error, files.folder(path, linked=True):
            pass
        assert str(error.value) == f"cannot write {path}: {said}"
    with pytest.raises(InputError) as error:
        files.replace(link / "x.png", b"")
    assert str(error.value) == f"cannot write {link / 'x.png'}: {said}"
    assert link.is_symlink()


def test_a_folder_found_by_itself_is_no_link(folder, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (folder / "link").symlink_to(tmp_path / "elsewhere")
    with files.folder(folder / "link", linked=True):
        pass
    with pytest.raises(InputError) as caught, files.folder(folder / "link", linked=False):
        pass
    assert str(caught.value) == f"cannot write {folder / 'link'}: is a link"


# ---------------------------------------------------------------- in a stranger's folder


SWEEP = ("duration=0.5", "--quiet", "--out")


@pytest.mark.parametrize(
    "name", ["experiment-forward_roll_1.yaml", "sweep.jsonl.part", "sweep.part", "summary.csv.part"]
)
def test_no_link_leads_a_sweep_out_of_its_folder(cli, folder, victim, name):
    (folder / name).symlink_to(victim)
    arguments = ("+experiment=forward_roll_1", "behaviour=forward_roll_1", "seed=0")
    assert cli("sweep", *arguments, *SWEEP, folder)[::2] == (0, "")
    assert cli("summarise", folder)[0] == 0
    assert victim.read_text() == "precious"


def test_the_lock_is_no_link(cli, folder, tmp_path):
    (folder / "sweep.lock").symlink_to(tmp_path / "made")
    said = f"rotctl: cannot write {folder / 'sweep.lock'}: is a link\n"
    assert cli("sweep", "seed=0", *SWEEP, folder)[::2] == (2, said)
    assert not (tmp_path / "made").exists()


def test_a_run_is_not_put_where_a_link_leads(cli, folder, tmp_path):
    assert cli("run", *SWEEP[:1], "--quiet", "--out", tmp_path / "first")[::2] == (0, "")
    (run,) = (tmp_path / "first").iterdir()
    (tmp_path / "elsewhere").mkdir()
    (folder / run.name).symlink_to(tmp_path / "elsewhere")
    said = f"rotctl: cannot write {folder / run.name}: is a link\n"
    assert cli("run", *SWEEP[:1], "--quiet", "--out", folder)[::2] == (2, said)
    assert cli("sweep", "seed=0", *SWEEP, folder)[::2] == (2, said)
    assert os.listdir(tmp_path / "elsewhere") == []


def test_a_report_leaves_alone_what_links_lead_to(cli, folder, tmp_path, drawing):
    assert cli("sweep", "seed=0", *SWEEP, folder)[::2] == (0, "")
    site, elsewhere = tmp_path / "site", tmp_path / "elsewhere"
    site.mkdir()
    elsewhere.mkdir()
    (elsewhere / "precious.svg").touch()
    (site / "charts").symlink_to(elsewhere)
    theirs = "is there, and of no earlier report; choose another --out"
    assert cli("report", folder, "--out", site)[::2] == (
        2,
        f"rotctl: {site / 'charts'}: {theirs}\n",
    )
    assert os.listdir(elsewhere) == ["precious.svg"]


def test_the_history_of_a_search_is_no_link(folder, victim):
    space = load_space("rolling_gains")
    for name in ("study.db", "study.db-journal", "study.db-wal"):
        (folder / name).symlink_to(victim)
        with pytest.raises(InputError) as caught:
            open_history(folder, space, {})
        said = f"{folder / name}: is a link; only plain files are read here"
        assert str(caught.value) == said
        (folder / name).unlink()


def test_no_journal_of_sqlite_names_a_file_to_be_removed(folder, victim):
    """SQLite finishes a transaction of several databases by removing the file it names."""
    journal(folder, victim)
    with pytest.raises(InputError) as caught:
        open_history(folder, load_space("rolling_gains"), {})
    assert str(caught.value) == (
        f"{folder / 'study.db-journal'}: is of a transaction over several databases"
    )
    assert victim.exists()


def journal(folder, victim):
    """A database that was cut off in a transaction that named `victim` as its super-journal."""
    database = sqlite3.connect(folder / "first.db", isolation_level=None)
    database.execute("create table x (x)")
    database.execute("pragma cache_size = 1")
    database.execute("begin")
    for _ in range(50):
        database.execute("insert into x values (randomblob(20000))")
    (folder / "study.db").write_bytes((folder / "first.db").read_bytes())
    cut_off = (folder / "first.db-journal").read_bytes()
    database.close()
    name = str(victim).encode()
    record = struct.pack(">I", 2**30 // 4096 + 1) + name
    record += struct.pack(">II", len(name), sum(name)) + bytes.fromhex("d9d505f920a163d7")
    (folder / "study.db-journal").write_bytes(cut_off + record)


def test_who_waits_for_another_writer_does_not_wait_for_ever(folder, monkeypatch):
    monkeypatch.setattr(replacement, "PATIENCE", 0.02)
    with files.replacing(folder / "a") as part:
        part.write_text("first")
        said = f"^cannot write {folder / 'a'}: another process has been writing it for 0.02 s$"
        with pytest.raises(InputError, match=said):
            files.replace(folder / "a", b"second")
    assert (folder / "a").read_text() == "first"
