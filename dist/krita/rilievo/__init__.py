# SPDX-License-Identifier: MIT OR Apache-2.0
"""Relight in Rilievo: opens a copy of the document there, and takes what was saved back as a layer."""

import os
import shutil
import subprocess
import tempfile
import zipfile

from krita import Extension, InfoObject, Krita

try:
    from PyQt5.QtWidgets import QFileDialog, QMessageBox
except ImportError:
    from PyQt6.QtWidgets import QFileDialog, QMessageBox

TITLE = "Rilievo"
LAYER = "Relit in Rilievo"
# The copies that were opened: by the document, the file and when it was written.
COPIES = {}


class Refused(Exception):
    """What is wrong, in a sentence for the user."""


def identity(document):
    """What stays the same for a document while it is open."""
    return document.rootNode().uniqueId().toString()


def named_program():
    """The program's path: as it was named before, or as it is installed; None without one."""
    named = Krita.instance().readSetting("rilievo", "program", "")
    return named if named and os.path.exists(named) else os.environ.get("RILIEVO") or shutil.which("rilievo")


def ask_for_program():
    path, _ = QFileDialog.getOpenFileName(None, "Where is the program Rilievo?")
    if not path:
        raise Refused("Rilievo is not installed. Install it, or name the program when you are asked.")
    Krita.instance().writeSetting("rilievo", "program", path)
    return path


def write_copy(document):
    """Write the document as an OpenRaster file with its layers; returns its name."""
    stem = os.path.splitext(os.path.basename(document.fileName()))[0] or document.name() or "drawing"
    stem = "".join(c if c.isalnum() or c in " -_" else "_" for c in stem)
    path = os.path.join(tempfile.mkdtemp(prefix="rilievo-"), stem + ".ora")
    # What came back last time lies above what is lit.
    shown = [node for node in document.topLevelNodes() if node.name() == LAYER and node.visible()]
    asks = document.batchmode()
    document.setBatchmode(True)
    for node in shown:
        node.setVisible(False)
    document.waitForDone()
    written = document.exportImage(path, InfoObject())
    for node in shown:
        node.setVisible(True)
    document.setBatchmode(asks)
    if not written or not os.path.exists(path):
        raise Refused(f"Krita cannot write {path}.")
    COPIES[identity(document)] = (path, os.stat(path).st_mtime_ns)
    return path


def relit_node(document):
    """The layer for what comes back: the one of last time, or a new one above all."""
    for node in document.topLevelNodes():
        if node.name() == LAYER and node.type() == "paintlayer":
            return node
    node = document.createNode(LAYER, "paintlayer")
    document.rootNode().addChildNode(node, None)
    return node


def take_back(document):
    """Put what Rilievo saved above the layers of the document."""
    path, written = COPIES.get(identity(document), (None, 0))
    if path is None:
        raise Refused("This document was not opened in Rilievo yet: choose “Relight in Rilievo”.")
    if not os.path.exists(path) or os.stat(path).st_mtime_ns == written:
        raise Refused("Nothing was saved in Rilievo yet: press Ctrl S there.")
    # Every OpenRaster file holds the picture of all layers, as the program that wrote it shows them.
    with zipfile.ZipFile(path) as archive:
        picture = archive.extract("mergedimage.png", os.path.dirname(path))
    opened = Krita.instance().openDocument(picture)
    if opened is None:
        raise Refused(f"Krita cannot read {picture}.")
    try:
        opened.setBatchmode(True)
        # Bytes are copied, so both must have the same kind of them.
        opened.setColorSpace(document.colorModel(), document.colorDepth(), document.colorProfile())
        opened.waitForDone()
        width, height = opened.width(), opened.height()
        pixels = opened.pixelData(0, 0, width, height)
    finally:
        opened.close()
    node = relit_node(document)
    # Krita 5.1 returns nothing.
    if node.setPixelData(pixels, 0, 0, width, height) is False:
        raise Refused("The layer cannot be painted on; is it locked?")
    document.refreshProjection()
    return node


class RilievoExtension(Extension):
    """The two commands in the menu."""

    def setup(self):
        pass

    def createActions(self, window):
        for name, text, work in (
            ("rilievo_relight", "Relight in Rilievo", self.relight),
            ("rilievo_take_back", "Take back from Rilievo", self.take_back),
        ):
            action = window.createAction(name, text, "tools/scripts")
            action.triggered.connect(lambda _checked=False, work=work: self.try_to(work))

    def try_to(self, work):
        document = Krita.instance().activeDocument()
        try:
            if document is None:
                raise Refused("Open a picture first.")
            work(document)
        except (Refused, OSError, KeyError, zipfile.BadZipFile) as error:
            QMessageBox.warning(None, TITLE, str(error))

    def relight(self, document):
        path = named_program() or ask_for_program()
        subprocess.Popen([path, "open", write_copy(document)])

    def take_back(self, document):
        take_back(document)


Krita.instance().addExtension(RilievoExtension(Krita.instance()))
