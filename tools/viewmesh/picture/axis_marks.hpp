#pragma once
// The directions of x, y and z, and a bar of a round length, in the lower left corner of a picture. page/marks.js draws
// the same.

#include "tools/viewmesh/camera.hpp"
#include "tools/viewmesh/picture/canvas.hpp"

namespace hexpipe::viewmesh::picture {

// `unit`: of the scene, in lengths of the mesh. Letters have `em` pixels.
void draw_axis_marks(Picture& picture, const Camera& camera, double unit, double em, bool dark);

// The greatest of 1, 2 and 5 times a power of ten that is not longer.
double round_length(double length);

}  // namespace hexpipe::viewmesh::picture
