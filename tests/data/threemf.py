#!/usr/bin/python3
"""threemf.py FILE [inch] - writes a 3MF file by Python's zipfile alone: a red cube "base" with a green top, a "knob" that is placed twice, once
mirrored, by components of another file of the archive, and a support that is not to be built."""
import sys
import zipfile

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
COLOURS = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
PARTS = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
# Corner x + 2 y + 4 z; the last two triangles are the top.
FACES = [(0, 2, 3), (0, 3, 1), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5), (4, 5, 7), (4, 7, 6)]


def cube(top=""):
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>\n' for z in (0, 1) for y in (0, 1) for x in (0, 1))
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"{top if i >= 10 else ""}/>\n' for i, (a, b, c) in enumerate(FACES))
    return f"<mesh><vertices>\n{vertices}</vertices><triangles>\n{triangles}</triangles></mesh>"


def model(unit, resources, build=""):
    return (f'<?xml version="1.0" encoding="UTF-8"?>\n<model unit="{unit}" xmlns="{CORE}" xmlns:m="{COLOURS}" xmlns:p="{PARTS}">\n'
            f"<resources>{resources}</resources><build>{build}</build></model>\n")


def main():
    unit = sys.argv[2] if len(sys.argv) > 2 else "millimeter"
    knobs = ('<component objectid="7" p:path="/3D/Objects/knob.model" transform="1 0 0 0 1 0 0 0 1 2 0 0"/>'
             '<component objectid="7" p:path="/3D/Objects/knob.model" transform="-1 0 0 0 1 0 0 0 1 -1 0 0"/>')
    base = cube(top=' pid="5" p1="1"')
    root = model(unit, '<m:colorgroup id="5"><m:color color="#FF0000"/><m:color color="#00FF00"/></m:colorgroup>'
                 f'<object id="1" type="model" name="base" pid="5" pindex="0">{base}</object>'
                 f'<object id="2" type="model"><components>{knobs}</components></object>'
                 f'<object id="3" type="support">{cube()}</object>',
                 '<item objectid="1"/><item objectid="2" transform="1 0 0 0 1 0 0 0 1 0 0 1"/><item objectid="3"/>')
    with zipfile.ZipFile(sys.argv[1], "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("_rels/.rels", '<Relationships><Relationship Target="/3D/base.model" Id="r" '
                         'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
        archive.writestr("3D/base.model", root)
        archive.writestr("3D/Objects/knob.model", model("millimeter", f'<object id="7" name="knob">{cube()}</object>'))


if __name__ == "__main__":
    main()
