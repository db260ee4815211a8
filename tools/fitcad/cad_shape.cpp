#include "tools/fitcad/cad_shape.hpp"

#include <fmt/format.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "common/mesh/item_lists.hpp"
#include "common/run/error.hpp"
#include "common/run/muted_cout.hpp"
#include "tools/fitcad/nearest_simplex.hpp"
#include "tools/fitcad/newton.hpp"

namespace hexpipe::fitcad {
namespace {

// Segments are chords of their curves. So a curve may be the nearest one though its segments are further away than
// those of another, by up to this share of the reach.
constexpr double curve_slack = 0.2;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Face {
  BRepAdaptor_Surface surface;
  std::unique_ptr<BRepTopAdaptor_FClass2d> borders;
  std::int32_t tag;

  bool contains(const std::array<double, 2>& parameters) const {
    return borders->Perform(gp_Pnt2d(parameters[0], parameters[1])) != TopAbs_OUT;
  }
};

// A triangle of a face, with the face's parameters at its corners.
struct FaceTriangle {
  std::int32_t face;
  std::array<std::array<double, 2>, 3> parameters;
};

// A segment of an edge, with the edge's parameters at its ends.
struct EdgeSegment {
  std::int32_t edge;
  std::array<double, 2> parameters;
};

struct EdgeSegments {
  std::vector<EdgeSegment> of;
  std::vector<Simplex> simplices;
};

using Tags = std::vector<std::int32_t>;  // ascending

// The nearest triangle of a face, or the nearest segment of an edge.
struct Near {
  std::int32_t simplex;
  double distance;
};

void keep_nearest(std::map<std::int32_t, Near>& found, std::int32_t owner, std::int32_t number, const Simplex& simplex,
                  const Vec3& to) {
  const double distance = norm(to - point_of(simplex, nearest_weights(simplex, to)));
  const auto [entry, is_new] = found.try_emplace(owner, Near{number, distance});
  if (!is_new && distance < entry->second.distance) entry->second = {number, distance};
}

}  // namespace

struct CadShape::State {
  State(const pipeline::ExactShape& shape, const std::string& source);

  void read(const pipeline::ExactShape& shape, const std::string& source);
  void add_face(const TopoDS_Face& face, std::int32_t tag);
  void add_edge(std::int32_t number, const TopoDS_Edge& edge, const TopoDS_Face& face, bool is_feature);
  std::vector<std::pair<std::int32_t, std::int32_t>> faces_near(const Vec3& to, double reach,
                                                                std::span<const std::int32_t> tags) const;
  Foot foot_on(std::int32_t triangle, const Vec3& to, std::array<double, 2>& parameters) const;
  Foot foot_on_edge(const EdgeSegment& of, const Simplex& simplex, const Vec3& to) const;
  std::optional<Foot> nearest_foot(const EdgeSegments& of, const SimplexTree& tree, const Vec3& to, double slack) const;
  std::optional<Foot> nearest_foot(const EdgeSegments& of, const SimplexTree& tree, const Vec3& to,
                                   const std::map<std::int32_t, Near>& found) const;
  std::map<std::int32_t, Near> features_near(const Vec3& to, double reach) const;
  std::optional<Foot> foot_of_feature(const Vec3& to, double reach, std::map<std::int32_t, Near> found) const;

  Foot in_mesh_unit(const Vec3& to, Foot foot) const {
    foot.at *= 1 / unit;
    foot.distance = norm(to - foot.at);
    return foot;
  }
  std::optional<Foot> in_mesh_unit(const Vec3& to, const std::optional<Foot>& foot) const {
    return foot ? std::optional(in_mesh_unit(to, *foot)) : std::nullopt;
  }

  double unit;
  double diagonal = 0;
  TopoDS_Shape whole;
  std::vector<Face> faces;
  std::vector<FaceTriangle> triangles;
  std::vector<Simplex> simplices;
  std::vector<std::optional<BRepAdaptor_Curve>> curves;  // by edge
  std::vector<Tags> tags_around;                         // by edge: those of its faces
  Tags tags;                                             // of all faces
  EdgeSegments edges, features;                          // all edges, and those that are features
  std::vector<Vec3> corners;
  std::vector<Vec3> nodes;
  std::optional<SimplexTree> triangle_tree, edge_tree, feature_tree;
};

CadShape::State::State(const pipeline::ExactShape& shape, const std::string& source) : unit(shape.unit) {
  const MutedCout muted;
  Message::DefaultMessenger()->ChangePrinters().Clear();
  try {
    read(shape, source);
  } catch (const Standard_Failure& failure) {
    throw DataError::at(source, "surface/shape.brep: OpenCASCADE failed: {}", failure.GetMessageString());
  }
  if (simplices.empty()) throw DataError::at(source, "surface/shape.brep: expected faces with triangles, found none");
  Box box = Box::around(simplices.front());
  for (const Simplex& simplex : simplices) box.add(Box::around(simplex));
  diagonal = norm(box.high - box.low);
  triangle_tree.emplace(simplices);
  edge_tree.emplace(edges.simplices);
  feature_tree.emplace(features.simplices);
}

void CadShape::State::read(const pipeline::ExactShape& shape, const std::string& source) {
  std::istringstream text(shape.brep);
  BRepTools::Read(whole, text, BRep_Builder());
  if (whole.IsNull()) throw DataError::at(source, "surface/shape.brep: expected a shape in BREP, found none");
  TopTools_IndexedMapOfShape all_faces;
  TopExp::MapShapes(whole, TopAbs_FACE, all_faces);
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
  TopExp::MapShapesAndAncestors(whole, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
  const auto check = [&](const char* what, std::size_t found, int wanted) {
    if (found != static_cast<std::size_t>(wanted))
      throw DataError::at(source, "surface/shape.json: expected tags of {} {}, found {}", wanted, what, found);
  };
  check("faces", shape.face_tags.size(), all_faces.Extent());
  check("edges", shape.edge_tags.size(), faces_of_edge.Extent());
  for (int i = 1; i <= all_faces.Extent(); ++i) add_face(TopoDS::Face(all_faces.FindKey(i)), shape.face_tags[i - 1]);
  tags = shape.face_tags;
  sort_unique(tags);
  const auto tag_of = [&](const TopoDS_Shape& face) { return shape.face_tags[all_faces.FindIndex(face) - 1]; };
  curves.resize(static_cast<std::size_t>(faces_of_edge.Extent()));
  tags_around.resize(curves.size());
  for (int i = 1; i <= faces_of_edge.Extent(); ++i) {
    const TopTools_ListOfShape& around = faces_of_edge.FindFromIndex(i);
    const TopoDS_Edge& edge = TopoDS::Edge(faces_of_edge.FindKey(i));
    if (around.IsEmpty() || BRep_Tool::Degenerated(edge)) continue;
    curves[i - 1].emplace(edge);
    for (const TopoDS_Shape& face : around) tags_around[i - 1].push_back(tag_of(face));
    sort_unique(tags_around[i - 1]);
    add_edge(i - 1, edge, TopoDS::Face(around.First()), shape.edge_tags[i - 1] != 0);
  }
}

void CadShape::State::add_face(const TopoDS_Face& face, std::int32_t tag) {
  const auto number = static_cast<std::int32_t>(faces.size());
  faces.push_back({BRepAdaptor_Surface(face), std::make_unique<BRepTopAdaptor_FClass2d>(face, 1e-9), tag});
  TopLoc_Location place;
  const Handle(Poly_Triangulation) made = BRep_Tool::Triangulation(face, place);
  if (made.IsNull() || !made->HasUVNodes()) return;
  const auto node = [&](Standard_Integer i) {
    return vec3_of(made->Node(i).Transformed(place.Transformation()).XYZ());
  };
  for (Standard_Integer i = 1; i <= made->NbNodes(); ++i) nodes.push_back(node(i));
  for (Standard_Integer i = 1; i <= made->NbTriangles(); ++i) {
    std::array<Standard_Integer, 3> corner{};
    made->Triangle(i).Get(corner[0], corner[1], corner[2]);
    FaceTriangle triangle{number, {}};
    Simplex simplex;
    for (int k = 0; k < 3; ++k) {
      const gp_Pnt2d uv = made->UVNode(corner[k]);
      triangle.parameters[k] = {uv.X(), uv.Y()};
      simplex[k] = node(corner[k]);
    }
    triangles.push_back(triangle);
    simplices.push_back(simplex);
  }
}

void CadShape::State::add_edge(std::int32_t number, const TopoDS_Edge& edge, const TopoDS_Face& face, bool is_feature) {
  TopLoc_Location place;
  const Handle(Poly_Triangulation) made = BRep_Tool::Triangulation(face, place);
  if (made.IsNull()) return;
  const auto polygon = BRep_Tool::PolygonOnTriangulation(edge, made, place);
  if (polygon.IsNull() || !polygon->HasParameters()) return;
  const auto node = [&](Standard_Integer i) {
    return vec3_of(made->Node(polygon->Node(i)).Transformed(place.Transformation()).XYZ());
  };
  for (Standard_Integer i = 2; i <= polygon->NbNodes(); ++i) {
    const EdgeSegment of{number, {polygon->Parameter(i - 1), polygon->Parameter(i)}};
    const Simplex simplex{node(i - 1), node(i), node(i)};
    edges.of.push_back(of);
    edges.simplices.push_back(simplex);
    if (!is_feature) continue;
    features.of.push_back(of);
    features.simplices.push_back(simplex);
  }
  if (!is_feature) return;
  for (TopExp_Explorer vertex(edge, TopAbs_VERTEX); vertex.More(); vertex.Next())
    corners.push_back(vec3_of(BRep_Tool::Pnt(TopoDS::Vertex(vertex.Current())).XYZ()));
}

// Each face that counts for CadShape::on_faces(), with the nearest of its triangles.
std::vector<std::pair<std::int32_t, std::int32_t>> CadShape::State::faces_near(
    const Vec3& to, double reach, std::span<const std::int32_t> tags) const {
  const double nearest = triangle_tree->distance(to, infinity);
  std::map<std::int32_t, Near> found;
  for (const std::int32_t t : triangle_tree->within(to, nearest * (1 + 1e-9) + reach))
    keep_nearest(found, triangles[t].face, t, simplices[t], to);
  std::vector<std::pair<std::int32_t, std::int32_t>> result;
  for (const auto& [face, near] : found) result.emplace_back(face, near.simplex);
  const auto has_tag = [&](const auto& entry) { return std::ranges::find(tags, faces[entry.first].tag) != tags.end(); };
  if (std::ranges::any_of(result, has_tag)) std::erase_if(result, [&](const auto& entry) { return !has_tag(entry); });
  return result;
}

Foot CadShape::State::foot_on(std::int32_t triangle, const Vec3& to, std::array<double, 2>& parameters) const {
  const FaceTriangle& of = triangles[triangle];
  const Weights w = nearest_weights(simplices[triangle], to);
  for (int i = 0; i < 2; ++i)
    parameters[i] = w[0] * of.parameters[0][i] + w[1] * of.parameters[1][i] + w[2] * of.parameters[2][i];
  const SurfacePlace place = nearest_on_surface(faces[of.face].surface, parameters, to);
  parameters = place.parameters;
  return {place.at, norm(to - place.at)};
}

Foot CadShape::State::foot_on_edge(const EdgeSegment& of, const Simplex& simplex, const Vec3& to) const {
  const Weights w = nearest_weights(simplex, to);
  const double start = w[0] * of.parameters[0] + (w[1] + w[2]) * of.parameters[1];
  const Vec3 at = nearest_on_curve(*curves[of.edge], start, to);
  return {at, norm(to - at)};
}

// The nearest point of the edges whose segments are at most `slack` further away than the nearest one.
std::optional<Foot> CadShape::State::nearest_foot(const EdgeSegments& of, const SimplexTree& tree, const Vec3& to,
                                                  double slack) const {
  if (tree.empty()) return std::nullopt;
  std::map<std::int32_t, Near> found;
  for (const std::int32_t i : tree.within(to, tree.distance(to, infinity) * (1 + 1e-9) + slack))
    keep_nearest(found, of.of[i].edge, i, tree.simplex(i), to);
  return nearest_foot(of, tree, to, found);
}

std::optional<Foot> CadShape::State::nearest_foot(const EdgeSegments& of, const SimplexTree& tree, const Vec3& to,
                                                  const std::map<std::int32_t, Near>& found) const {
  std::optional<Foot> best;
  for (const auto& [edge, near] : found) {
    const Foot foot = foot_on_edge(of.of[near.simplex], tree.simplex(near.simplex), to);
    if (!best || foot.distance < best->distance) best = foot;
  }
  return best;
}

// The edges that are features and may have a point at most `reach` away.
std::map<std::int32_t, Near> CadShape::State::features_near(const Vec3& to, double reach) const {
  std::map<std::int32_t, Near> found;
  for (const std::int32_t i : feature_tree->within(to, (1 + curve_slack) * reach))
    keep_nearest(found, features.of[i].edge, i, features.simplices[i], to);
  return found;
}

// The nearest point of some of these; nullopt if it is more than `reach` away.
std::optional<Foot> CadShape::State::foot_of_feature(const Vec3& to, double reach,
                                                     std::map<std::int32_t, Near> found) const {
  double nearest = infinity;
  for (const auto& [edge, near] : found) nearest = std::min(nearest, near.distance);
  std::erase_if(found, [&](const auto& entry) { return entry.second.distance > nearest + curve_slack * reach; });
  const std::optional<Foot> foot = nearest_foot(features, *feature_tree, to, found);
  return foot && foot->distance <= reach ? foot : std::nullopt;
}

CadShape::CadShape(const pipeline::ExactShape& shape, const std::string& source)
    : state_(std::make_unique<State>(shape, source)) {}
CadShape::~CadShape() = default;
CadShape::CadShape(CadShape&&) noexcept = default;

// Arguments and results are in the unit of the mesh, `State` is in that of the CAD.
Foot CadShape::on_faces(const Vec3& to, double reach, std::span<const std::int32_t> tags) const {
  const State& s = *state_;
  const Vec3 p = s.unit * to;
  const auto near = s.faces_near(p, s.unit * reach, tags);
  std::optional<Foot> inside;
  Foot any{{}, infinity};
  for (const auto& [face, triangle] : near) {
    std::array<double, 2> parameters{};
    const Foot foot = s.foot_on(triangle, p, parameters);
    if (foot.distance < any.distance) any = foot;
    if (inside && foot.distance >= inside->distance) continue;
    if (near.size() == 1 || s.faces[face].contains(parameters)) inside = foot;
  }
  // The nearest points of all these surfaces are beyond the borders of their faces, so the nearest one is on an edge.
  if (!inside) inside = s.nearest_foot(s.edges, *s.edge_tree, p, s.unit * reach);
  return s.in_mesh_unit(to, inside.value_or(any));
}

std::optional<Foot> CadShape::on_curves(const Vec3& to, double reach, std::span<const std::int32_t> tags) const {
  const State& s = *state_;
  Tags wanted(tags.begin(), tags.end());
  std::ranges::sort(wanted);
  std::map<std::int32_t, Near> found = s.features_near(s.unit * to, s.unit * reach);
  const auto is_wanted = [&](const auto& entry) { return s.tags_around[entry.first] == wanted; };
  if (std::ranges::any_of(found, is_wanted)) std::erase_if(found, std::not_fn(is_wanted));
  return s.in_mesh_unit(to, s.foot_of_feature(s.unit * to, s.unit * reach, std::move(found)));
}

std::optional<Foot> CadShape::on_curves_within(const Vec3& to, double reach, std::int32_t tag) const {
  const State& s = *state_;
  std::map<std::int32_t, Near> found = s.features_near(s.unit * to, s.unit * reach);
  if (std::ranges::binary_search(s.tags, tag))
    std::erase_if(found, [&](const auto& entry) { return s.tags_around[entry.first] != Tags{tag}; });
  return s.in_mesh_unit(to, s.foot_of_feature(s.unit * to, s.unit * reach, std::move(found)));
}

std::optional<Vec3> CadShape::on_corners(const Vec3& to, double reach) const {
  std::optional<Vec3> best;
  for (const Vec3& corner : state_->corners) {
    const Vec3 at = (1 / state_->unit) * corner;
    const double distance = norm(at - to);
    if (distance > reach) continue;
    reach = distance;
    best = at;
  }
  return best;
}

std::vector<Vec3> CadShape::samples() const {
  const State& s = *state_;
  std::vector<Vec3> points;
  points.reserve(s.nodes.size() + s.triangles.size());
  for (const Vec3& node : s.nodes) points.push_back((1 / s.unit) * node);
  for (const FaceTriangle& of : s.triangles) {
    std::array<double, 2> middle{};
    for (int i = 0; i < 2; ++i) middle[i] = (of.parameters[0][i] + of.parameters[1][i] + of.parameters[2][i]) / 3;
    points.push_back((1 / s.unit) * vec3_of(s.faces[of.face].surface.Value(middle[0], middle[1]).XYZ()));
  }
  return points;
}

std::size_t CadShape::face_count() const {
  return state_->faces.size();
}

double CadShape::diagonal() const {
  return state_->diagonal / state_->unit;
}

}  // namespace hexpipe::fitcad
