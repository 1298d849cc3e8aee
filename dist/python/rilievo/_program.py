"""The program in the background."""

import json
import os
import shutil
import subprocess
import warnings

from ._document import Document


class RilievoError(Exception):
    """What the program refused, in its own words."""


class Program:
    """A running program. Use it in a ``with`` statement, or call :meth:`close`.

    ``path`` is the program; by default the environment variable ``RILIEVO``, or ``rilievo`` among
    the installed programs. With ``force``, existing files are replaced.
    """

    def __init__(self, path=None, force=False):
        path = path or os.environ.get("RILIEVO") or shutil.which("rilievo")
        if path is None:
            raise RilievoError("the program is not installed; name it with Program(path)")
        arguments = [os.fspath(path), "replay", "-"] + (["--force"] if force else [])
        self._process = subprocess.Popen(
            arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            encoding="utf-8",
        )

    def do(self, room, action, **fields):
        """Perform one action and return the reply, a dictionary.

        A field whose name is a Python word, such as ``in``, may end in ``_``. Raises
        :class:`RilievoError` if the program refuses; what it notes becomes a warning.
        """
        line = {"in": room, "do": action}
        line.update((name.rstrip("_"), _plain(value)) for name, value in fields.items())
        try:
            self._process.stdin.write(json.dumps(line) + "\n")
            self._process.stdin.flush()
            reply = self._process.stdout.readline()
        except (BrokenPipeError, ValueError):
            reply = ""
        if not reply:
            raise RilievoError("the program has ended")
        reply = json.loads(reply)
        for note in reply.get("notes", []):
            warnings.warn(note, stacklevel=3)
        if not reply["done"]:
            raise RilievoError(reply["error"])
        return reply

    def open(self, file):
        """Open a project, recipe, Photoshop file or picture."""
        self.do("file", "open", file=file)
        return Document(self)

    def open_maps(self, normal=None, depth=None):
        """Start a document on the surface of a normal map, a depth map, or both."""
        self.do("file", "open maps", normal=normal, depth=depth)
        return Document(self)

    def new(self, width, height, background=None):
        """Start an empty document."""
        self.do("file", "new", width=width, height=height, background=background)
        return Document(self)

    def close(self):
        """End the program. What was not saved is lost."""
        self._process.stdin.close()
        self._process.wait()
        self._process.stdout.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def _plain(value):
    """Paths as texts; all else as JSON has it."""
    return os.fspath(value) if isinstance(value, os.PathLike) else value
