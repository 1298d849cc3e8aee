# SPDX-License-Identifier: MIT OR Apache-2.0
"""Relights a drawing with the plug-in inside Krita, without a window: python test.py PROGRAM

Krita runs this file again by its program kritarunner. PROGRAM plays the part of the user in Rilievo.
"""

import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
WIDTH, HEIGHT = 120, 90
# A blue square in the middle of nothing; bytes of Krita are blue, green, red, alpha.
BLUE, NOTHING = bytes([200, 80, 40, 255]), bytes(4)


def square(x, y):
    return 30 <= x < 90 and 15 <= y < 75


def drawing():
    return b"".join(BLUE if square(x, y) else NOTHING for y in range(HEIGHT) for x in range(WIDTH))


def relight(program, path):
    """What the user does in Rilievo: a shape, light, and Ctrl S."""
    lines = [
        '{"in":"file","do":"open","file":"%s"}' % path,
        '{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}',
        '{"in":"file","do":"save","file":"%s"}' % path,
    ]
    replay = [program, "replay", "-", "--force"]
    subprocess.run(replay, input="\n".join(lines), text=True, check=True, stdout=subprocess.DEVNULL)


def refused(plugin, document):
    try:
        plugin.take_back(document)
    except plugin.Refused as error:
        return str(error)
    raise AssertionError("it was not refused")


def inside():
    """In Krita: a document goes out and comes back."""
    sys.path.insert(0, HERE)
    import rilievo as plugin
    from krita import Krita

    program = os.environ["RILIEVO"]
    krita = Krita.instance()
    document = krita.createDocument(WIDTH, HEIGHT, "A drawing: blue", "RGBA", "U8", "", 72.0)
    node = document.topLevelNodes()[0]
    node.setPixelData(drawing(), 0, 0, WIDTH, HEIGHT)
    document.refreshProjection()
    assert plugin.named_program() == program, plugin.named_program()
    assert "was not opened" in refused(plugin, document)
    path = plugin.write_copy(document)
    assert os.path.basename(path) == "A drawing_ blue.ora", path
    assert "press Ctrl S" in refused(plugin, document)
    relight(program, path)
    before = len(document.topLevelNodes())
    for _ in range(2):
        layer = plugin.take_back(document)
        assert len(document.topLevelNodes()) == before + 1, "a second time replaces the layer"
    top = document.topLevelNodes()[-1]
    assert top.name() == layer.name() == plugin.LAYER, [n.name() for n in document.topLevelNodes()]
    pixels = bytes(top.pixelData(0, 0, WIDTH, HEIGHT))
    at = lambda x, y: tuple(pixels[4 * (y * WIDTH + x) :][:4])
    assert at(2, 2)[3] == 0 and at(60, 45)[3] == 255, "what was transparent stays so"
    left, right = at(36, 24), at(84, 66)
    assert sum(left[:3]) > sum(right[:3]) + 40, f"light comes from the upper left: {left}, {right}"
    assert bytes(node.pixelData(0, 0, WIDTH, HEIGHT)) == drawing(), "the drawing itself is not changed"
    again = plugin.write_copy(document)
    told = subprocess.run([program, "info", again], capture_output=True, text=True, check=True).stdout
    assert "hidden" in told and top.visible(), f"what came back is not lit again: {told}"
    deep = krita.createDocument(WIDTH, HEIGHT, "deep", "RGBA", "U16", "", 72.0)
    relight(program, plugin.write_copy(deep_with_square(deep)))
    pixels = bytes(plugin.take_back(deep).pixelData(60, 45, 1, 1))
    assert len(pixels) == 8 and pixels[6:] == b"\xff\xff", pixels
    commands(plugin)
    print("krita: a drawing was relit")


def deep_with_square(document):
    """The same drawing in 16 bits, in which a byte twice is the same value."""
    data = bytes(byte for byte in drawing() for _ in range(2))
    document.topLevelNodes()[0].setPixelData(data, 0, 0, WIDTH, HEIGHT)
    document.refreshProjection()
    return document


def commands(plugin):
    """The menu's commands, on a window that only notes what it is asked for."""
    asked, warned = [], []

    class Signal:
        def connect(self, work):
            self.work = work

    class Action:
        def __init__(self):
            self.triggered = Signal()

    class Window:
        def createAction(self, name, text, menu):
            asked.append((name, text, menu, Action()))
            return asked[-1][3]

    plugin.QMessageBox.warning = lambda _parent, _title, text: warned.append(text)
    plugin.RilievoExtension(plugin.Krita.instance()).createActions(Window())
    assert [menu for _, _, menu, _ in asked] == ["tools/scripts"] * 2, asked
    for _, _, _, action in asked:
        action.triggered.work(False)
    # Without a window no document is active.
    assert warned == ["Open a picture first."] * 2, warned


def __main__(_arguments):
    """Called by kritarunner, which ends with 0 whatever happens here."""
    try:
        inside()
    except BaseException:
        import traceback

        traceback.print_exc()
        os._exit(1)
    os._exit(0)


def main(program):
    runner = shutil.which("kritarunner")
    if runner is None:
        print("krita: skipped: kritarunner is not installed")
        return 0
    # Python in Krita finds its modules beside the first python3 on the path: the system's, as Krita's own.
    path = os.path.dirname(runner) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as home:
        environment = {**os.environ, "PATH": path, "PYTHONPATH": HERE, "HOME": home, "TMPDIR": home}
        environment |= {"QT_QPA_PLATFORM": "offscreen", "RILIEVO": os.path.abspath(program)}
        run = [runner, "-s", "test", "-f", "__main__"]
        done = subprocess.run(run, env=environment, check=False, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        print(done.stderr[-3000:], file=sys.stderr)
    return done.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
