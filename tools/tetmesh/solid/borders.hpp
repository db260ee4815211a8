#pragma once
// Borders of a soup: edges of a single triangle. Rounding and uneven cuts leave them where there is no gap to see.

#include <cstddef>
#include <vector>

#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::tetmesh::solid {

// Drops the triangles that are not kept, with everything that the soup holds for each of them.
void keep_only(formats::SurfaceSoup& soup, const std::vector<bool>& kept);

// How far rounding may move a point, where coordinates have six digits or four bytes: a millionth of the greatest of
// them, but no more than a ten thousandth of the box's diagonal.
double rounding_of(const formats::SurfaceSoup& soup);

// Makes one point of points of borders that are this near to each other and have no edge between them. Returns how many
// points went. Triangles may collapse.
std::size_t weld_borders(formats::SurfaceSoup& soup, double tolerance);

// Cuts triangles whose border leads through other points of borders, within the tolerance (T-junctions), so that edges
// end there. Returns the number of such places. No triangle may repeat a vertex.
std::size_t cut_at_border_points(formats::SurfaceSoup& soup, double tolerance);

// Whether an open component may be a sheet, not a body with a hole: a flat sheet inside a border of that length would
// be as large or larger.
bool is_sheet(double area, double border);

// Removes open components that share no edge with others and are sheets. They have at most four triangles, or a
// hundredth of the area of the closed components, of which there must be some. Two triangles back to back are such a
// component, too. Returns the number of triangles that went. No triangle may repeat a vertex.
std::size_t remove_stray_sheets(formats::SurfaceSoup& soup);

// Whether an edge has a single triangle.
bool has_borders(const formats::SurfaceSoup& soup);

}  // namespace hexpipe::tetmesh::solid
