#!/usr/bin/python3
"""Changes the FreeCAD document beside it (legs.FCStd, made by FreeCAD 0.20: a plate cut from hidden solids, a foot in a part that is turned, a link
to the foot, and a FEM constraint on a face) for tests.

    fcstd.py KIND > FILE

KIND is one of those at the end of this file.
"""
import pathlib
import re
import struct
import sys
import zipfile
from io import BytesIO

LEGS = pathlib.Path(__file__).with_name("legs.FCStd")


def views(**shown):
    """GuiDocument.xml with the visibility of objects, and with a colour for each face of the plate."""
    def view(name):
        colours = '<Property name="ShapeColor"><PropertyColor value="3435973887"/></Property><Property name="DiffuseColor"><ColorList file="DiffuseColor"/></Property>'
        return (f'<ViewProvider name="{name}"><Properties><Property name="Visibility"><Bool value="{str(shown[name]).lower()}"/></Property>'
                f'{colours if name == "Cut" else ""}</Properties></ViewProvider>')
    return f'<Document><ViewProviderData>{"".join(map(view, shown))}</ViewProviderData></Document>'


def coloured(files):
    files["GuiDocument.xml"] = views(Cut=True, Foot=True, Link=False).encode()
    # Seven faces: the constraint's face and another one have a colour that the object does not have.
    files["DiffuseColor"] = struct.pack("<8I", 7, *[0x00ff0000 if face in (1, 6) else 0xcccccc00 for face in range(1, 8)])


def hidden(files):
    files["GuiDocument.xml"] = views(Cut=False, Part=False, Link=False).encode()


def in_a_circle(files):
    files["Document.xml"] = files["Document.xml"].replace(b'name="Foot"/>\n                </Property>', b'name="Link"/>\n                </Property>')


def array(files):
    """The link shows the foot at three places, 5 apart, as FreeCAD writes them."""
    files["Document.xml"] = re.sub(rb'(name="ElementCount".*?<Integer value=)"0"', rb'\1"3"', files["Document.xml"], flags=re.S)
    files["PlacementList"] = struct.pack("<I", 3) + b"".join(struct.pack("<7d", 5 * i, 0, 0, 0, 0, 0, 1) for i in range(3))


def short_array(files):
    array(files)
    files["PlacementList"] = files["PlacementList"][:-1]


def elsewhere(files):
    files["Document.xml"] = files["Document.xml"].replace(b'<XLink file=""', b'<XLink file="feet/legs.FCStd"')


def without_shape(files):
    del files["PartShape2.brp"]


def damaged_shape(files):
    files["PartShape2.brp"] = files["PartShape2.brp"][:900]


def cut_off(files):
    files["Document.xml"] = files["Document.xml"][:5000]


KINDS = {"coloured": coloured, "hidden": hidden, "in-a-circle": in_a_circle, "array": array, "short-array": short_array, "elsewhere": elsewhere,
         "without-shape": without_shape, "damaged-shape": damaged_shape, "cut-off": cut_off}


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in KINDS:
        sys.exit(__doc__ + "\n" + " ".join(KINDS))
    with zipfile.ZipFile(LEGS) as legs:
        before = {name: legs.read(name) for name in legs.namelist()}
    after = dict(before)
    KINDS[sys.argv[1]](after)
    if after == before:
        sys.exit(f"{sys.argv[1]} changes nothing")
    made = BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in after.items():
            archive.writestr(name, data)
    sys.stdout.buffer.write(made.getvalue())
