#!/usr/bin/python3
"""render.py MESH PICTURE [AXIS FRACTION] - a picture of a hex-dominant mesh, cut open so that its inside is seen.

Whole cells beyond FRACTION of the way along AXIS (x, y or z; default y 0.5) are taken away. Hexes are coloured by scaled
Jacobian, other cells are grey. Reads VTU; needs python3-vtk9 and a display (xvfb-run serves).
"""
import sys

import vtk
from vtk.util.numpy_support import vtk_to_numpy
import numpy as np

HEX, VOLUME_KINDS = 12, (10, 12, 13, 14)


def cells_kept(grid, axis, fraction):
    """Numbers of the volume cells whose centre lies before the cut."""
    centres = vtk.vtkCellCenters()
    centres.SetInputData(grid)
    centres.Update()
    along = vtk_to_numpy(centres.GetOutput().GetPoints().GetData())[:, axis]
    low, high = grid.GetBounds()[2 * axis:2 * axis + 2]
    kinds = vtk_to_numpy(grid.GetCellTypesArray())
    return np.flatnonzero((along <= low + fraction * (high - low)) & np.isin(kinds, VOLUME_KINDS))


def part(grid, cells):
    ids = vtk.vtkIdTypeArray()
    for cell in cells:
        ids.InsertNextValue(int(cell))
    node = vtk.vtkSelectionNode()
    node.SetFieldType(vtk.vtkSelectionNode.CELL)
    node.SetContentType(vtk.vtkSelectionNode.INDICES)
    node.SetSelectionList(ids)
    selection = vtk.vtkSelection()
    selection.AddNode(node)
    extract = vtk.vtkExtractSelection()
    extract.SetInputData(0, grid)
    extract.SetInputData(1, selection)
    extract.Update()
    return extract.GetOutput()


def colours():
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(256)
    stops = np.array([[0.80, 0.25, 0.20], [0.95, 0.75, 0.35], [0.55, 0.75, 0.85], [0.25, 0.50, 0.75]])
    for i in range(256):
        t = i / 255 * (len(stops) - 1)
        k = min(int(t), len(stops) - 2)
        table.SetTableValue(i, *(stops[k] * (1 - t + k) + stops[k + 1] * (t - k)), 1)
    table.SetRange(0.3, 1)
    return table


def actor_of(grid, by_quality):
    skin = vtk.vtkGeometryFilter()
    skin.SetInputData(grid)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(skin.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    if by_quality:
        mapper.SetScalarModeToUseCellFieldData()
        mapper.SelectColorArray("quality")
        mapper.SetLookupTable(colours())
        mapper.UseLookupTableScalarRangeOn()
    else:
        mapper.ScalarVisibilityOff()
        actor.GetProperty().SetColor(0.93, 0.92, 0.88)
    look = actor.GetProperty()
    look.EdgeVisibilityOn()
    look.SetEdgeColor(0.15, 0.17, 0.20)
    look.SetLineWidth(1.2)
    look.SetAmbient(0.25)
    look.SetDiffuse(0.8)
    return actor


def main():
    source, target = sys.argv[1:3]
    axis = "xyz".index(sys.argv[3]) if len(sys.argv) > 3 else 1
    fraction = float(sys.argv[4]) if len(sys.argv) > 4 else 0.5
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(source)
    reader.Update()
    grid = reader.GetOutput()
    kinds = vtk_to_numpy(grid.GetCellTypesArray())
    kept = cells_kept(grid, axis, fraction)

    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor_of(part(grid, kept[kinds[kept] == HEX]), by_quality=True))
    renderer.AddActor(actor_of(part(grid, kept[kinds[kept] != HEX]), by_quality=False))
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(1600, 1000)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    direction = np.array([0.45, 0.45, 0.45])
    direction[axis] = 1.1
    camera.SetPosition(*direction)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(*((0, 0, 1) if axis != 2 else (0, 1, 0)))
    renderer.ResetCamera()
    camera.Zoom(1.5)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(target)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


main()
