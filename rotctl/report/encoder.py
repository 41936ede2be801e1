"""Frames to an MP4 file, by an ffmpeg in a process of its own.

rotctl links no encoder: ffmpeg and x264 are under the GPL, rotctl is not.
"""

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO, cast

from rotctl.errors import InputError

HINT = "pip install 'rotctl[video]', or on Debian: apt-get install ffmpeg"


def executable() -> str:
    """Path of an ffmpeg: that of imageio-ffmpeg, else the system's.

    Raises:
        InputError: there is none.
    """
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        return str(get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        found = shutil.which("ffmpeg")
    if found is None:
        raise InputError(f"cannot make a video: no ffmpeg here; {HINT}")
    return found


@contextmanager
def encoding(program: str, out: Path, size: tuple[int, int], rate: float) -> Iterator[IO[bytes]]:
    """A stream that takes frames, RGB bytes one after the other, into an H.264 MP4 file.

    Args:
        program: from `executable`.
        size: width and height in pixels; both even.
        rate: [frames/s].

    Raises:
        InputError: ffmpeg fails.
    """
    width, height = size
    command = [program, "-hide_banner", "-loglevel", "error", "-nostdin", "-y"]
    command += ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"]
    command += ["-r", f"{rate:g}", "-i", "pipe:0", "-an", "-c:v", "libx264", "-preset", "veryfast"]
    command += ["-crf", "23", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
    # The same frames give the same bytes.
    command += ["-threads", "1", "-fflags", "+bitexact", "-flags:v", "+bitexact"]
    command += ["-f", "mp4", f"file:{out}"]
    with TemporaryFile() as said:
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=said
        )
        stream = cast(IO[bytes], process.stdin)
        broken = False
        try:
            yield stream
            stream.close()
        except BrokenPipeError:
            broken = True
        except BaseException:
            process.kill()
            raise
        finally:
            code = process.wait()
        if broken or code:
            said.seek(0)
            lines = said.read().decode("utf-8", "replace").strip().splitlines() or ["no reason"]
            raise InputError(f"cannot make a video: ffmpeg says: {lines[-1]:.200}")
