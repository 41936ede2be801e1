"""The command line: what it prints where, its exit codes, and how it takes misuse and signals."""

import importlib.machinery
import json
import os
import resource
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import mujoco
import pytest
import yaml
from logs import changed
from sweep_cli import ENDLESS, PATIENCE, command, finish, start, until

from rotctl import __version__
from rotctl.cli import parser
from rotctl.cli.interrupting import interruptible
from rotctl.cli.main import main
from rotctl.errors import InputError
from rotctl.log import RunLog

RUN = ["run", "duration=0.5"]
COMMANDS = ("run", "render", "replay", "plot", "list", "show", "inspect", "verify", "bench")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A short run: its folder of runs, its row, and its log."""
    out = tmp_path_factory.mktemp("made")
    assert main([*RUN, "--out", str(out), "--quiet"]) == 0
    (folder,) = out.iterdir()
    return out, json.loads((folder / "summary.json").read_text()), folder / "run.h5"


# ---------------------------------------------------------------- run


def test_from_another_folder_json_is_all_there_is_on_stdout(tmp_path):
    code, stdout, stderr = finish(*RUN, "seed=3", "--out", "my runs/ü", "--json", cwd=tmp_path)
    assert (code, stdout.count("\n"), stderr) == (0, 1, "")
    row = json.loads(stdout)
    assert row["seed"] == 3
    folder = tmp_path / "my runs" / "ü" / row["run_id"]
    assert json.loads((folder / "summary.json").read_text()) == row
    assert os.listdir(tmp_path) == ["my runs"]
    RunLog.open(folder / "run.h5").verify()


def test_a_second_identical_run_is_reported_and_force_redoes_it(cli, tmp_path):
    out = tmp_path
    row = json.loads(cli(*RUN, "--out", out, "--json")[1])
    (log,) = out.glob("*/run.h5")
    before = log.stat().st_mtime_ns
    code, stdout, stderr = cli(*RUN, "--out", out, "--json")
    assert (code, json.loads(stdout)) == (0, row)
    assert stderr == f"already there, not redone (--force redoes it): {log.parent}\n"
    assert log.stat().st_mtime_ns == before
    code, stdout, stderr = cli(*RUN, "--out", out, "--json", "--force")
    assert (code, stderr) == (0, "")
    assert log.stat().st_mtime_ns > before


def test_whose_run_is_there_already_is_told_where_other_code_has_made_it(cli, tmp_path):
    cli(*RUN, "--out", tmp_path, "--quiet")
    (log,) = tmp_path.glob("*/run.h5")
    older = changed(RunLog.open(log), tmp_path, git_commit="0123456789" * 4, git_dirty=False)
    os.replace(older.path, log)
    made_by = f"made by rotctl {__version__} (0123456), mujoco {mujoco.__version__}"
    told = f"already there, {made_by}, not redone (--force redoes it): {log.parent}\n"
    assert cli(*RUN, "--out", tmp_path)[::2] == (0, told)


def test_quiet_prints_nothing(cli, made, tmp_path):
    assert cli(*RUN, "--out", made[0], "--quiet") == (0, "", "")
    assert cli(*RUN, "--out", tmp_path, "--quiet") == (0, "", "")


def test_a_person_gets_a_readable_summary_and_the_path_of_the_log(cli, made):
    out, row, log = made
    code, stdout, _ = cli(*RUN, "--out", out)
    lines = stdout.splitlines()
    assert code == 0
    assert (
        lines[0] == f"forward_roll_1  seed 0  run {row['run_id']}  FAILED: {row['failure_reason']}"
    )
    assert lines[-1] == f"log        {log}"
    assert "commanded 1.30" in stdout
    assert "0 solver failures" in stdout


def test_a_damaged_log_is_redone_and_said(cli, tmp_path):
    cli(*RUN, "--out", tmp_path, "--quiet")
    (log,) = tmp_path.glob("*/run.h5")
    os.truncate(log, 1000)
    code, stdout, stderr = cli(*RUN, "--out", tmp_path, "--json")
    assert code == 0
    assert stderr == (
        f"simulated again, the log there could not be used: {log}: truncated or damaged HDF5 file\n"
    )
    RunLog.open(log).verify()


def test_a_breakdown_is_exit_code_1_and_a_row(cli, tmp_path):
    arguments = ("run", "duration=1", "start.speed_x=[1e12,1e12]", "--out", tmp_path)
    for _ in range(2):  # simulated, then reported
        code, stdout, _ = cli(*arguments, "--json")
        row = json.loads(stdout, parse_constant=lambda constant: pytest.fail(constant))
        assert (code, row["success"], row["speed_mean"]) == (1, False, None)
    code, stdout, _ = cli(*arguments)
    assert code == 1
    assert "FAILED: physics broke down at t = 0.00 s: MuJoCo warns: velocity" in stdout
    assert "speed        - m/s (commanded 1.20)" in stdout


def test_a_roll_that_stalls_is_a_result(cli, tmp_path):
    code, stdout, _ = cli(
        "run", "duration=2", "start=rest", "behaviour.angular_velocity=0", "behaviour.speed=0",
        "criteria.stall_time=0.1", "--out", tmp_path, "--json",
    )  # fmt: skip
    row = json.loads(stdout)
    assert (code, row["success"]) == (0, False)
    assert row["failure_reason"].startswith("stalled for ")


def test_overrides_and_options_may_be_mixed(cli, made):
    out, row, _ = made
    for arguments in (
        ["run", "--out", out, "--json", "seed=0", "duration=0.5"],
        ["run", "duration=0.5", "--out", out, "seed=0", "--json"],
        ["run", "duration=9", "--json", "seed=0", "--out", out, "duration=0.5"],
    ):
        code, stdout, _ = cli(*arguments)
        assert (code, json.loads(stdout)) == (0, row)


# ---------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([*RUN, "controller.solver=foo"], "rotctl: controller.solver='foo' is unknown; valid: "
         "boxqp, osqp, qpsolvers:<name> (for example qpsolvers:daqp)"),
        ([*RUN, "start=foo"], 'rotctl: start="foo": no such choice; valid: aloft, armstand, '
         "falling, long, poised, prone, raised, rest, running, side, standing, still, supine, "
         "symmetric, tucked, tucked_back"),
        ([*RUN, "seed=1,2"], "rotctl: override 'seed=1,2': run takes one value for seed; "
         "rotctl sweep takes many"),
        ([*RUN, "seed"], "rotctl: override 'seed' has no '='; write key=value, such as seed=3"),
        ([*RUN, "--out", ""], "rotctl run: argument --out: the name is empty; "
         "see rotctl run --help"),
        (["summarise", ""], "rotctl summarise: argument DIR: the name is empty; "
         "see rotctl summarise --help"),
        (["summarise", "x", "--by", ""], "rotctl summarise: argument --by: names no column; "
         "see rotctl summarise --help"),
        (["show", "+experiment=table1"], "rotctl: +experiment=table1: is for sweeps: "
         "rotctl sweep +experiment=NAME"),
        ([*RUN, "experiment=table1"], "rotctl: experiment=table1: is for sweeps: "
         "rotctl sweep +experiment=NAME"),
        (["sweep", "experiment=table1"], "rotctl: experiment=table1: write +experiment=table1"),
        (["verify", ""], "rotctl verify: argument RUN.h5: the name is empty; "
         "see rotctl verify --help"),
        (["render", "x.h5", "--filmstrip", "x.png", "--video", "x.avi"],
         "rotctl: x.avi: valid endings: .mp4"),
        (["render", "x.h5", "--video", "x.mp4", "--frames", "3"],
         "rotctl: --frames=3: is of a filmstrip; a video has 30 a second"),
        ([*RUN, "--frce"], "rotctl run: unrecognized arguments: --frce (did you mean "
         "--force?); see rotctl run --help"),
        ([*RUN, "--forc"], "rotctl run: unrecognized arguments: --forc (did you mean "
         "--force?); see rotctl run --help"),
        (["list", "x", "y"], "rotctl list: unrecognized arguments: y; see rotctl list --help"),
        (["list", "terain"], "rotctl: \"terain\": no such group; did you mean terrain? valid: "
         "behaviour, catch, character, controller, course, criteria, disturbance, excursion, "
         "finish, physics, plant, reference, start, terrain, motion, tune, experiments"),
        ([], "rotctl: the following arguments are required: COMMAND; see rotctl --help"),
        (["inspect"], "rotctl inspect: the following arguments are required: RUN.h5; "
         "see rotctl inspect --help"),
        (["bench", "--repeats", "0"], "rotctl: --repeats=0: must be at least 1"),
        (["bench", "--plot", "x.txt"], "rotctl: x.txt: valid endings: .svg, .png, .pdf"),
        (["sweep", "seed=0", "--out", "x", "--jobs", "100000"],
         "rotctl: --jobs=100000: valid: 1 to 1024"),
        (["sweep", "seed=0", "--out", "x", "--jobs", "0"], "rotctl: --jobs=0: valid: 1 to 1024"),
        (["sweep", "seed=range(0,1e9)", "--out", "x"],
         "rotctl: the sweep has more than 100000 points; make several sweeps"),
        (["preview-motion", "forward_roll", "--out", "x.txt"],
         "rotctl: x.txt: valid endings: .png"),
        (["inspect", "nothing.h5"], "rotctl: nothing.h5: no such file"),
        (["inspect", "x" * 300], f"rotctl: {'x' * 300}: no such file"),
        (["inspect", "."], "rotctl: .: is a folder without run.h5; "
         "name a run, its folder or the log in it; rotctl ls . lists them"),
        (["render", "nothing.h5", "--filmstrip", "x.png"], "rotctl: nothing.h5: no such file"),
        (["render", ".", "--filmstrip", "x.png"], "rotctl: .: is a folder without run.h5; "
         "name a run, its folder or the log in it; rotctl ls . lists them"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line_and_exit_code_2(cli, tmp_path, monkeypatch, arguments, message):
    monkeypatch.chdir(tmp_path)
    assert cli(*arguments) == (2, "", message + "\n")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    "arguments", [RUN, ["show"], ["list"], ["render", "x.h5", "--video", "x.mp4"]]
)
def test_a_backend_of_opengl_that_there_is_not(cli, tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MUJOCO_GL", "bogus")
    code, stdout, stderr = cli(*arguments)
    assert (code, stdout) == (2, "")
    assert stderr.startswith(
        "rotctl: MUJOCO_GL=bogus: no such OpenGL; valid: osmesa, egl, glfw, disable; unset it to"
    )
    assert stderr.count("\n") == 1
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("arguments", [["show", "--part", "seed"], ["diff", "{log}", "{log}"]])
def test_who_draws_nothing_needs_no_opengl_that_works(made, arguments):
    """In a process of its own: MuJoCo, imported by itself, raises where its OpenGL does."""
    words = [word.format(log=made[2]) for word in arguments]
    code, _, stderr = finish(*words, env={**os.environ, "MUJOCO_GL": "wgl"})  # which Windows has
    assert (code, stderr) == (0, "")


def test_what_is_not_known_is_not_repeated_at_length(cli):
    code, _, stderr = cli("run", "--" + "a" * 10**6)
    assert (code, len(stderr.splitlines())) == (2, 1)
    assert len(stderr) < 2100
    assert stderr.endswith("aaa...; see rotctl run --help\n")


def test_an_unknown_command_is_answered_with_the_known_ones(cli):
    code, stdout, stderr = cli("rol")
    assert (code, stdout) == (2, "")
    assert stderr.count("\n") == 1
    assert all(name in stderr for name in COMMANDS)


def test_a_file_where_the_folder_should_be(cli, tmp_path):
    (tmp_path / "file").write_text("")
    code, stdout, stderr = cli(*RUN, "--out", tmp_path / "file", "--json")
    assert (code, stdout) == (2, "")
    assert stderr.startswith(f"rotctl: cannot write {tmp_path / 'file'}/")
    assert stderr.endswith(": Not a directory\n")


def test_a_full_disk_is_one_line_and_leaves_nothing(cli, tmp_path):
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, limits[1]))
    try:
        code, stdout, stderr = cli(*RUN, "--out", tmp_path / "out", "--json")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert (code, stdout) == (2, "")
    assert stderr.startswith(f"rotctl: cannot write {tmp_path / 'out'}/")
    assert stderr.endswith("/run.h5: File too large\n")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("override", ["duration=1e-9", "controller.solver=qpsolvers:no"])
def test_a_config_that_makes_no_run_leaves_no_folder(cli, tmp_path, override):
    assert cli("run", override, "--out", tmp_path / "a" / "b", "--json")[:2] == (2, "")
    assert os.listdir(tmp_path) == []


# ---------------------------------------------------------------- signals and pipes


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_leaves_its_beginning_and_exits_with_130(number, tmp_path):
    process = _begun(tmp_path)
    process.send_signal(number)
    stdout, stderr = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert stdout == ""
    assert stderr == (
        "rotctl: interrupted; an unfinished run leaves no log; of one of more than a minute its "
        "beginning is in interrupted.h5\n"
    )
    # None, if not one step was made.
    assert [p.name for p in tmp_path.rglob("*") if p.is_file()] in ([], ["interrupted.h5"])


def test_a_killed_run_leaves_no_log(tmp_path):
    process = _begun(tmp_path)
    process.kill()
    process.communicate(timeout=PATIENCE)
    assert [*tmp_path.rglob("run.h5")] == []


def _begun(out):
    """A run in another process, seen to have begun, with minutes to go."""
    process = start("run", ENDLESS, "--out", out, "--json")
    until(lambda: os.listdir(out) or process.poll() is not None)
    assert process.poll() is None
    return process


def test_signals_mean_again_what_they_meant(cli):
    some = signal.SIGINT, signal.SIGTERM, signal.SIGALRM
    before = [sys.unraisablehook, *(signal.getsignal(number) for number in some)]
    assert cli("list")[0] == 0
    assert [sys.unraisablehook, *(signal.getsignal(number) for number in some)] == before


def test_an_alarm_of_who_calls_a_command_stays_his(cli):
    rung = []
    before = signal.signal(signal.SIGALRM, lambda *_: rung.append(1))
    try:
        signal.setitimer(signal.ITIMER_REAL, 600.0)
        with interruptible():
            signal.raise_signal(signal.SIGALRM)
        assert signal.getitimer(signal.ITIMER_REAL)[0] > 0.0
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert rung == [1]


def test_pythons_loader_of_c_is_known_by_its_name():
    loads = importlib.machinery.ExtensionFileLoader.create_module
    assert loads.__code__.co_qualname.startswith("ExtensionFileLoader.")


class _Goes:
    """What it does as it goes nobody can catch."""

    def __init__(self, number):
        self._number = number

    def __del__(self):
        signal.raise_signal(self._number)


class ExtensionFileLoader:
    """As Python's own of that name: C, such as MuJoCo's, that takes any error for one of its."""

    def __init__(self, number):
        try:
            signal.raise_signal(number)
        except BaseException:
            raise ImportError("initialization failed") from None


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("loses", [ExtensionFileLoader, _Goes])
def test_a_signal_that_would_be_lost_interrupts_all_the_same(loses, number, cli, monkeypatch):
    def goes_on():
        loses(number)
        time.sleep(PATIENCE)

    monkeypatch.setattr("rotctl.cli.main.gl.chosen", goes_on)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may ignore it
    try:
        assert cli("show")[::2] == (130, "rotctl: interrupted; an unfinished run leaves no log\n")
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_signal_of_the_last_moment_is_not_lost():
    with pytest.raises(KeyboardInterrupt), interruptible(), suppress(ImportError):
        ExtensionFileLoader(signal.SIGTERM)


def test_what_goes_wrong_after_a_signal_is_told_as_what_it_is(cli, monkeypatch):
    """Of a signal that was caught, as one is by who cleans up."""

    def cleaned_up():
        with suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGTERM)
        raise InputError("a disk is full")

    monkeypatch.setattr("rotctl.cli.main.gl.chosen", cleaned_up)
    assert cli("show")[::2] == (2, "rotctl: a disk is full\n")


def test_a_reader_that_has_seen_enough_is_no_error():
    process = subprocess.Popen(command("show"), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdout.close()
    assert process.stderr.read() == b""
    assert process.wait(timeout=PATIENCE) == 0


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("told", [subprocess.PIPE, subprocess.STDOUT])
def test_the_exit_code_is_the_commands_own_where_nobody_reads_what_it_prints(
    made, tmp_path, unbuffered, told
):
    """Neither stdout nor, where `told` goes there too, stderr."""
    log = RunLog.open(made[2])
    other = changed(log, tmp_path, {"trajectory/ctrl": 2.0 * log["trajectory/ctrl"]})
    environment = {**os.environ, "PYTHONUNBUFFERED": unbuffered}
    for words, code in ((["verify", other.path], 1), (["run", "seed=a"], 2), (["--help"], 0)):
        process = subprocess.Popen(
            command(*words), stdout=subprocess.PIPE, stderr=told, env=environment
        )
        process.stdout.close()
        said = process.stderr.read() if process.stderr else b""
        assert (process.wait(timeout=PATIENCE), b"Broken pipe" in said) == (code, False)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux has it")
def test_a_full_stdout_is_one_line():
    with open("/dev/full", "w") as full:
        finished = subprocess.run(
            command("list"), stdout=full, stderr=subprocess.PIPE, text=True, timeout=PATIENCE
        )
    assert finished.returncode == 2
    assert finished.stderr == "rotctl: output: No space left on device\n"


def test_a_closed_stdout_is_no_error():
    finished = subprocess.run(
        command("list"),
        stderr=subprocess.PIPE,
        text=True,
        timeout=PATIENCE,
        preexec_fn=lambda: os.close(1),
    )
    assert (finished.returncode, finished.stderr) == (0, "")


def test_any_path_can_be_printed(tmp_path):
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "1"}
    code, stdout, _ = finish(*RUN, "--out", "ü", cwd=tmp_path, env=environment)
    assert code == 0
    assert "log        \\xfc/" in stdout


# ---------------------------------------------------------------- help, list, show, inspect


def test_one_blas_thread_whatever_the_shell_says(cli, monkeypatch):
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        monkeypatch.setenv(name, "4")
        cli("list")
        assert os.environ[name] == "1"


def test_help_needs_no_heavy_import():
    script = (
        "import sys; from rotctl.cli.main import main\n"
        "try: main(['--help'])\n"
        "except SystemExit: pass\n"
        "heavy = {'mujoco', 'numpy', 'hydra', 'h5py', 'pydantic', 'tqdm', 'yaml', 'scipy'}\n"
        "sys.exit(', '.join(heavy & set(sys.modules)) or 0)\n"
    )
    finished = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=PATIENCE
    )
    assert (finished.returncode, finished.stderr) == (0, "")
    assert "exit codes: 0 simulated" in finished.stdout


NO_ENGINE = {
    "list": "",
    "new": "behaviour mine --from stand",
    "ls": "{folder}",
    "diff": "{log} {log}",
    "inspect": "{log}",
    "completion": "bash",
}


@pytest.mark.parametrize("name", NO_ENGINE)
def test_what_simulates_nothing_does_not_wait_for_the_engine(made, tmp_path, name):
    folder, _, log = made
    words = [name, *NO_ENGINE[name].format(folder=folder, log=log).split()]
    script = (
        "import sys; from rotctl.cli.main import main\n"
        f"assert main({words}) == 0\n"
        "assert 'mujoco' not in sys.modules"
    )
    asked = [sys.executable, "-c", script]
    finished = subprocess.run(asked, cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE)
    assert (finished.returncode, finished.stderr) == (0, "")


def test_those_are_the_commands_that_have_it_not():
    assert set(NO_ENGINE) == set(parser.WITHOUT_MUJOCO)


@pytest.mark.parametrize("name", COMMANDS)
def test_each_command_has_a_help_that_says_what_it_does(cli, name):
    code, stdout, stderr = cli(name, "--help")
    assert (code, stderr) == (0, "")
    paragraphs = stdout.split("\n\n")
    assert paragraphs[0].startswith(f"usage: rotctl {name} ")
    assert len(paragraphs[1]) > 40  # its description
    assert cli("--help")[1].count(f"\n    {name} ") == 1


def test_version(cli):
    assert cli("--version") == (0, f"rotctl {__version__}\n", "")


def test_list_has_every_group_and_choice_with_its_description(cli):
    code, stdout, stderr = cli("list")
    assert (code, stderr) == (0, "")
    lines = stdout.splitlines()
    assert lines[0] == "behaviour"
    assert any(line.startswith("  forward_roll_1  ") for line in lines)
    for group in ("character", "controller", "physics", "start", "terrain"):
        assert group in lines
    assert all(line.strip().count("  ") for line in lines if line.startswith("  "))


def test_one_group_is_listed_alone(cli):
    for group in ("start", "experiments"):
        lines = cli("list", group)[1].splitlines()
        assert lines[0].split()[0] == group
        assert all(line.startswith("  ") for line in lines[1:-2])


def test_show_prints_the_config_as_yaml(cli):
    code, stdout, stderr = cli("show", "seed=7", "start=rest")
    assert (code, stderr) == (0, "")
    data = yaml.safe_load(stdout)
    assert data["seed"] == 7
    assert data["start"]["name"] == "rest"


def test_the_config_of_a_run_is_shown(cli, made, tmp_path, monkeypatch):
    out, row, log = made
    monkeypatch.chdir(tmp_path)
    os.symlink(out, "runs")
    for run in (row["run_id"], log.parent, log):
        code, stdout, stderr = cli("show", run)
        assert (code, stdout, stderr) == (0, (log.parent / "config.yaml").read_text(), "")
    assert cli("show", "runs")[2].startswith("rotctl: override 'runs' has no '='")


def test_an_id_of_a_run_elsewhere_is_told_how_to_name_it(cli):
    for word in ("verify", "show"):
        assert cli(word, "0123456789ab") == (
            2,
            "",
            "rotctl: 0123456789ab: no such file, and no run of that id in runs; write the folder "
            "that it is in before it, as in sweeps/mine/0123456789ab\n",
        )
    code, _, stderr = cli("show", "runs/aaaaaaaaaaaa")
    assert (code, stderr) == (2, "rotctl: runs/aaaaaaaaaaaa: no such file\n")


def test_a_part_of_a_config_is_shown_alone(cli):
    whole = yaml.safe_load(cli("show", "start=rest")[1])
    for key, wanted in (
        ("start", {"start": whole["start"]}),
        ("controller.pose", {"pose": whole["controller"]["pose"]}),
        ("character.bodies.0.name", {"name": "pelvis"}),
        (".", whole),
    ):
        code, stdout, _ = cli("show", "start=rest", "--part", key)
        assert (code, yaml.safe_load(stdout)) == (0, wanted)
    assert cli("show", "--part", "controller.pos")[2].startswith(
        "rotctl: unknown key 'controller.pos'; did you mean pose? valid keys under controller: "
    )
    assert cli("show", "--part", "seed.x")[2] == (
        "rotctl: unknown key 'seed.x'; valid keys under seed: none, it is a value\n"
    )


def test_inspect_shows_everything_and_checks_it(cli, made):
    out, row, log = made
    code, stdout, stderr = cli("inspect", log)
    assert (code, stderr) == (0, "")
    assert stdout.startswith(f"{log}  run {row['run_id']}  schema 4\n")
    for text in ("trajectory/qpos", "[kg m2/s]", "outcome", "success", "git_commit", "machine"):
        assert text in stdout
    assert stdout.endswith("\nintegrity  complete, checksums match\n")


@pytest.fixture(scope="module")
def falsified(made, tmp_path_factory):
    """A log whose outcome somebody has written anew."""
    import h5py

    path = tmp_path_factory.mktemp("falsified") / "run.h5"
    path.write_bytes(made[2].read_bytes())
    with h5py.File(path, "r+") as file:
        row = json.loads(file.attrs["outcome"])
        file.attrs["outcome"] = json.dumps(row | {"success": True, "failure_reason": ""})
    return path


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "--again", "{log}", "--out", "runs", "--quiet"],
        ["show", "{log}"],
        ["replay", "{log}", "--html", "x.html"],
        ["plot", "{log}", "--out", "x.svg"],
        ["export", "{log}", "--to", "bvh", "--out", "x.bvh"],
        ["diff", "{log}", "{log}"],
        ["new", "start", "fallen", "--from", "{log}"],
    ],
)
def test_a_log_that_was_changed_is_told_whatever_it_is_used_for(
    cli, falsified, tmp_path, monkeypatch, arguments
):
    monkeypatch.chdir(tmp_path)
    code, _, stderr = cli(*(text.format(log=falsified) for text in arguments))
    said = "damaged, its content does not match its SHA-256; taken as it is"
    assert code == 0
    assert {*stderr.splitlines()} == {f"rotctl: {falsified}: {said}"}


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (lambda log: log[:5000], "truncated or damaged HDF5 file"),
        (lambda log: b"time,x\n0,1\n", "not an HDF5 file"),
        (lambda log: b"", "not an HDF5 file"),
    ],
)
def test_inspect_refuses_what_is_no_log(cli, made, tmp_path, content, reason):
    path = tmp_path / "x.h5"
    path.write_bytes(content(made[2].read_bytes()))
    assert cli("inspect", path) == (2, "", f"rotctl: {path}: {reason}\n")


def test_inspect_refuses_a_foreign_hdf5(cli, tmp_path):
    import h5py

    path = tmp_path / "x.h5"
    with h5py.File(path, "w") as file:
        file["a"] = 1
    message = f"rotctl: {path}: not a rotctl log (no schema_version)\n"
    assert cli("inspect", path) == (2, "", message)


@pytest.mark.parametrize(
    ("arguments", "endings"),
    [
        (["render", "{log}", "--filmstrip", "out.txt"], ".png"),
        (["render", "{log}", "--video", "out.txt"], ".mp4"),
        (["replay", "{log}", "--html", "out.txt"], ".html, .htm"),
    ],
)
def test_a_file_is_not_called_what_it_is_not(cli, made, arguments, endings):
    command = [text.format(log=made[2]) for text in arguments]
    assert cli(*command) == (2, "", f"rotctl: out.txt: valid endings: {endings}\n")


def test_a_key_that_is_grouped_by_twice(cli, made):
    said = "rotctl: --by: names 'seed' twice\n"
    assert cli("summarise", made[0], "--by", "seed,seed") == (2, "", said)


def test_warnings_of_libraries_stay_off_the_terminal(tmp_path):
    """Numbers of the size of 1e13 overflow in squares of squares; the row says what broke down."""
    code, stdout, stderr = finish(
        "run", "behaviour.speed=1e13", "behaviour.angular_velocity=1e13", "duration=0.5", "--json",
        "--out", tmp_path,
    )  # fmt: skip
    assert (stdout.count("\n"), stderr) == (1, "")
    assert code in (0, 1)


def test_nothing_from_a_shell_or_a_file_steers_the_terminal(cli, tmp_path):
    assert cli("inspect", "\x1b[31m.h5") == (2, "", "rotctl: ?[31m.h5: no such file\n")
