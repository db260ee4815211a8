// Each face has triangles of its own, and OpenCASCADE lists their nodes along an edge in the order of the edge. So
// nodes of neighbouring faces become one by the edges and vertices that the faces share, never because they are close.

#include "tools/tessellate/triangulate.hpp"

#include <fmt/format.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <GProp_GProps.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

#include "common/mesh/defaults.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/joined_sets.hpp"
#include "common/run/error.hpp"
#include "tools/tessellate/face_gaps.hpp"
#include "tools/tessellate/short_edges.hpp"

namespace hexpipe::tessellate {
namespace {

constexpr double deviation_of_size = 0.01;
// A size for faces that enclose nothing, or whose walls have no thickness: of a deviation of nothing OpenCASCADE would
// make triangles for ever.
constexpr double size_of_diagonal = 0.05, least_thickness = 1e-6;

// How fine triangles are: the factors of what the options say.
struct Fineness {
  double angle = 1;
  double deviation = 1;

  bool is_coarser() const { return angle > 1 || deviation > 1; }
  double angle_of(const TriangulationOptions& options) const {
    return angle < 1 ? std::min(least_small_angle, angle * options.angle) : angle * options.angle;
  }
  static constexpr double least_small_angle = 5;  // in degrees
};

// What is tried where triangles cross. BRepMesh keeps the triangles of a face, and its points on edges, unless they
// were taken away or are less fine than the deviation asks for. So a smaller angle concerns these faces alone, what is
// coarser also those beside them, whose points on edges would stay, and a smaller deviation all. On HexMe's i27 the
// first helps, on splines of I-DEAS with many knots the second or the third, on an engine block among Gmsh's
// benchmarks the last one, which takes the triangles of all faces away.
constexpr double smaller_angle = 1.0 / 3, larger_angle = 2;
constexpr std::array fineness_where_crossing{
    Fineness{smaller_angle, 1},    Fineness{1, 0.5},         Fineness{1, 2}, Fineness{1, 4},
    Fineness{smaller_angle, 0.25}, Fineness{larger_angle, 2}};
// So large a model is not made finer.
constexpr std::size_t most_triangles = 1'000'000;

// Calls visit(edge) for each edge that bounds the face, turned so that the face's surface is on its left.
template <class Visit>
void for_edges_around(const TopoDS_Face& face, Visit&& visit) {
  for (TopExp_Explorer part(face.Oriented(TopAbs_FORWARD), TopAbs_EDGE); part.More(); part.Next()) {
    const TopAbs_Orientation turn = part.Current().Orientation();
    if (turn == TopAbs_FORWARD || turn == TopAbs_REVERSED) visit(TopoDS::Edge(part.Current()));
  }
}

// Those of a wire around the face, each beginning where the one before it ends; none if some are in no such order.
std::vector<TopoDS_Edge> edges_in_order(const TopoDS_Wire& wire, const TopoDS_Face& face) {
  std::vector<TopoDS_Edge> edges;
  for (BRepTools_WireExplorer part(wire, face); part.More(); part.Next()) edges.push_back(part.Current());
  if (edges.size() != static_cast<std::size_t>(wire.NbChildren())) edges.clear();
  return edges;
}

// Null if OpenCASCADE has made none; they lie at `place`.
Handle(Poly_Triangulation) triangles_of(const TopoDS_Face& face, TopLoc_Location& place) {
  const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, place);
  return triangles.IsNull() || triangles->NbTriangles() == 0 ? Handle(Poly_Triangulation)() : triangles;
}

// A step between nodes that are given in the edge's own order.
NodeEdge along(const TopoDS_Edge& edge, std::int32_t from, std::int32_t to) {
  return edge.Orientation() == TopAbs_FORWARD ? NodeEdge(from, to) : NodeEdge(to, from);
}

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

void mesh(const TopoDS_Compound& whole, double deviation, double angle) {
  IMeshTools_Parameters parameters;
  parameters.Deflection = deviation;
  parameters.Angle = radians(angle);
  parameters.InParallel = Standard_False;
  BRepMesh_IncrementalMesh(whole, parameters);
}

struct Attempt {
  Triangulation made;
  std::size_t crossings = 0;  // pairs of triangles of one body that cross each other
  TopTools_IndexedMapOfShape crossing_faces;
};

// Makes one surface of the triangles that the faces have.
class Triangulator {
 public:
  Triangulator(const CadModel& model, const TopoDS_Compound& whole, const TriangulationOptions& options,
               double deviation, const std::string& source)
      : model_(model), options_(options), source_(source), whole_(whole) {
    result_.deviation = deviation;
  }

  Attempt run() {
    result_.surface.name = source_;
    result_.surface.text = false;
    result_.surface.has_own_tags = true;
    TopExp::MapShapesAndAncestors(whole_, TopAbs_EDGE, TopAbs_FACE, faces_of_edge_);
    number_faces();
    choose_tags();
    for (std::size_t body = 0; body < model_.bodies.size(); ++body) add_body(body);
    close_tips();
    result_.joined_nodes += join_ends_without_length(result_.surface.triangles, nodes_, same_);
    add_curves();
    number_points();
    Attempt attempt;
    if (options_.open) {
      result_.surface.sides.clear();
    } else {
      check_closed();
      name_regions();
      find_crossings(attempt);
    }
    keep_shape();
    attempt.made = std::move(result_);
    return attempt;
  }

 private:
  void number_faces();
  void choose_tags();
  bool is_smooth(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) const;
  std::string group_of(const TopoDS_Shape& face) const { return model_.names.of(face); }
  void add_body(std::size_t body);
  void add_face(const TopoDS_Face& face, std::int32_t region);
  void add_empty_face(const TopoDS_Face& face, std::int32_t region);
  std::int32_t copy_of(std::int32_t node);
  std::vector<std::int32_t> nodes_along(const TopoDS_Edge& edge, const TopoDS_Face& face, std::int32_t region);
  void add_triangles(const TopoDS_Face& face, const std::vector<NodeEdge>& border, std::vector<Triangle> triangles,
                     bool is_mirrored, std::int32_t region);
  [[noreturn]] void fail_at(const TopoDS_Face& face, std::int32_t region) const;
  void add_nodes(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangles, const TopLoc_Location& place,
                 std::int32_t first);
  void join_edge(const TopoDS_Edge& edge, std::vector<std::int32_t> nodes);
  void close_tips();
  void add_curves();
  void number_points();
  std::vector<bool> flat_pairs();
  void drop_curves_without_triangles(const std::vector<Vertex>& number);
  void check_closed() const;
  void name_regions();
  void keep_shape();
  void find_crossings(Attempt& attempt) const;
  std::string title_of(const TopoDS_Face& face) const;
  std::size_t number_of(std::int32_t region) const { return model_.bodies[region - 1].number; }

  const CadModel& model_;
  const TriangulationOptions& options_;
  const std::string& source_;
  const TopoDS_Compound& whole_;
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge_;
  TopTools_IndexedMapOfShape faces_;
  std::vector<std::int32_t> tags_;                // of faces
  std::map<int, std::vector<std::size_t>> done_;  // triangles, by number of the face
  std::vector<TopoDS_Face> empty_faces_;          // of the current body
  bool shares_faces_ = false;                     // whether the current body shares some with another one
  std::vector<NodeEdge> tips_;                    // nodes that become one (face_gaps.hpp)
  std::vector<Vec3> nodes_;
  JoinedSets same_;
  std::map<int, std::vector<std::int32_t>> nodes_of_edge_;  // by number of the edge
  std::map<const void*, std::vector<std::pair<TopoDS_Shape, std::int32_t>>> node_of_vertex_;
  std::vector<int> face_of_triangle_;
  Triangulation result_;
};

void Triangulator::number_faces() {
  TopExp::MapShapes(whole_, TopAbs_FACE, faces_);
  result_.faces = static_cast<std::size_t>(faces_.Extent());
}

std::string Triangulator::title_of(const TopoDS_Face& face) const {
  const std::string name = group_of(face);
  return fmt::format("face {}{}", faces_.FindIndex(face), name.empty() ? "" : fmt::format(" ('{}')", name));
}

// Whether the surface goes on over the edge without a bend. An edge of a single face is a seam.
bool Triangulator::is_smooth(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) const {
  if (faces.Extent() > 2) return false;
  const TopoDS_Face one = TopoDS::Face(faces.First()), other = TopoDS::Face(faces.Last());
  if (faces.Extent() == 1 && !BRep_Tool::IsClosed(edge, one)) return false;
  return BRepLib::ContinuityOfFaces(edge, one, other, radians(options_.smooth_angle)) >= GeomAbs_G1;
}

// One tag for each name, and one for each group of faces without a name that continue each other smoothly.
void Triangulator::choose_tags() {
  JoinedSets components;
  for (int i = 0; i < faces_.Extent(); ++i) components.add();
  for (int e = 1; e <= faces_of_edge_.Extent(); ++e) {
    const TopTools_ListOfShape& faces = faces_of_edge_.FindFromIndex(e);
    const TopoDS_Edge& edge = TopoDS::Edge(faces_of_edge_.FindKey(e));
    if (faces.Extent() != 2 || BRep_Tool::Degenerated(edge)) continue;
    if (!group_of(faces.First()).empty() || !group_of(faces.Last()).empty() || !is_smooth(edge, faces)) continue;
    components.join(faces_.FindIndex(faces.First()) - 1, faces_.FindIndex(faces.Last()) - 1);
  }
  std::map<std::string, std::int32_t> named;
  std::map<std::int32_t, std::int32_t> unnamed;
  std::int32_t last = 0;
  for (int i = 0; i < faces_.Extent(); ++i) {
    const std::string group = group_of(faces_.FindKey(i + 1));
    std::int32_t& tag = group.empty() ? unnamed[components.of(i)] : named[group];
    if (tag == 0) tag = ++last;
    if (!group.empty()) result_.surface.names.surfaces[tag] = group;
    tags_.push_back(tag);
  }
}

void Triangulator::add_body(std::size_t body) {
  const auto region = static_cast<std::int32_t>(body + 1);
  const std::size_t first = result_.surface.triangles.size();
  shares_faces_ = false;
  for (TopExp_Explorer face(model_.bodies[body].solid, TopAbs_FACE); face.More(); face.Next())
    add_face(TopoDS::Face(face.Current()), region);
  const std::vector<TopoDS_Face> empty_faces = std::exchange(empty_faces_, {});
  if (options_.open)
    result_.empty_faces += empty_faces.size();
  else
    for (const TopoDS_Face& face : empty_faces) add_empty_face(face, region);
  // A solid's faces may point inward. A solid that shares faces with another one has the right orientation, and the
  // rest of its triangles enclose nothing.
  if (shares_faces_) return;
  double volume = 0;
  for (std::size_t i = first; i < result_.surface.triangles.size(); ++i) {
    if (result_.surface.sides[i][0] == result_.surface.sides[i][1]) continue;  // a baffle
    const auto [a, b, c] = result_.surface.triangles[i];
    volume += det(nodes_[a] - nodes_[0], nodes_[b] - nodes_[0], nodes_[c] - nodes_[0]);
  }
  if (volume >= 0) return;
  for (std::size_t i = first; i < result_.surface.triangles.size(); ++i)
    std::swap(result_.surface.triangles[i][1], result_.surface.triangles[i][2]);
}

void Triangulator::add_face(const TopoDS_Face& face, std::int32_t region) {
  const bool is_inside = face.Orientation() == TopAbs_INTERNAL;
  const bool is_of_none = face.Orientation() == TopAbs_EXTERNAL || (is_inside && !options_.keep_baffles);
  if (is_of_none && !options_.open) return;
  const int number = faces_.FindIndex(face);
  if (options_.open && done_.contains(number)) return;
  if (const auto found = done_.find(number); found != done_.end()) {
    // The triangles of the body on the other side get this region. If it is the same body, they are a wall inside and
    // go, or stay as a baffle.
    const std::array<std::int32_t, 2> of_wall =
        options_.keep_baffles ? std::array{region, region} : std::array<std::int32_t, 2>{0, 0};
    for (const std::size_t t : found->second) {
      auto& sides = result_.surface.sides[t];
      shares_faces_ = shares_faces_ || sides[0] != region;
      sides = sides[0] == region ? of_wall : std::array<std::int32_t, 2>{sides[0], region};
    }
    return;
  }
  TopLoc_Location place;
  const Handle(Poly_Triangulation) triangles = triangles_of(face, place);
  if (triangles.IsNull()) return empty_faces_.push_back(face);
  const auto first = static_cast<std::int32_t>(nodes_.size());
  const auto numbered = [&](Standard_Integer node) { return first + node - 1; };
  add_nodes(face, triangles, place, first);
  std::vector<Triangle> made;
  for (Standard_Integer i = 1; i <= triangles->NbTriangles(); ++i) {
    Standard_Integer a = 0, b = 0, c = 0;
    triangles->Triangle(i).Get(a, b, c);
    made.push_back({numbered(a), numbered(b), numbered(c)});
  }
  std::vector<NodeEdge> border;
  for_edges_around(face, [&](const TopoDS_Edge& edge) {
    const auto polygon = BRep_Tool::PolygonOnTriangulation(edge, triangles, place);
    if (polygon.IsNull()) return;
    for (Standard_Integer i = 1; i < polygon->NbNodes(); ++i)
      border.push_back(along(edge, numbered(polygon->Node(i)), numbered(polygon->Node(i + 1))));
  });
  add_triangles(face, border, std::move(made), place.Transformation().IsNegative(), region);
}

// A face of which OpenCASCADE has made no triangles gets some between the nodes of its neighbours.
void Triangulator::add_empty_face(const TopoDS_Face& face, std::int32_t region) {
  std::vector<NodeEdge> border;
  const TopoDS_Face forward = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
  for (TopExp_Explorer part(forward, TopAbs_WIRE); part.More(); part.Next()) {
    const std::vector<TopoDS_Edge> edges = edges_in_order(TopoDS::Wire(part.Current()), forward);
    if (edges.empty()) fail_at(face, region);
    std::vector<std::int32_t> loop;
    for (const TopoDS_Edge& edge : edges) {
      if (BRep_Tool::Degenerated(edge)) continue;
      const std::vector<std::int32_t> nodes = nodes_along(edge, face, region);
      loop.insert(loop.end(), nodes.begin(), nodes.end() - 1);
    }
    // A seam has its nodes on both sides of it.
    std::set<std::int32_t> met;
    for (std::int32_t& node : loop)
      if (!met.insert(node).second) node = copy_of(node);
    for (std::size_t i = 0; i < loop.size(); ++i) border.emplace_back(loop[i], loop[(i + 1) % loop.size()]);
  }
  add_triangles(face, border, {}, face.Location().Transformation().IsNegative(), region);
}

std::int32_t Triangulator::copy_of(std::int32_t node) {
  nodes_.push_back(nodes_[node]);
  const std::int32_t copy = same_.add();
  same_.join(node, copy);
  return copy;
}

// Nodes of an edge of a face without triangles, in the edge's direction, each by the lowest of its numbers. Where no
// face has triangles at the edge, they are made here.
std::vector<std::int32_t> Triangulator::nodes_along(const TopoDS_Edge& edge, const TopoDS_Face& face,
                                                    std::int32_t region) {
  const int number = faces_of_edge_.FindIndex(edge);
  if (!nodes_of_edge_.contains(number)) {
    TopLoc_Location place;
    for (const TopoDS_Shape& beside : faces_of_edge_.FindFromIndex(number))
      if (!triangles_of(TopoDS::Face(beside), place).IsNull()) fail_at(face, region);
    const BRepAdaptor_Curve curve(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)));
    const GCPnts_TangentialDeflection points(curve, radians(options_.angle), result_.deviation);
    std::vector<std::int32_t> nodes;
    for (Standard_Integer i = 1; i <= points.NbPoints(); ++i) {
      const gp_Pnt p = points.Value(i);
      nodes_.push_back({p.X(), p.Y(), p.Z()});
      nodes.push_back(same_.add());
    }
    join_edge(edge, std::move(nodes));
  }
  std::vector<std::int32_t> nodes = nodes_of_edge_.at(number);
  for (std::int32_t& node : nodes) node = same_.of(node);
  if (edge.Orientation() != TopAbs_FORWARD) std::ranges::reverse(nodes);
  return nodes;
}

// With those that are missing. They are turned as the face's surface is.
void Triangulator::add_triangles(const TopoDS_Face& face, const std::vector<NodeEdge>& border,
                                 std::vector<Triangle> triangles, bool is_mirrored, std::int32_t region) {
  const FilledGaps gaps = options_.open ? FilledGaps() : fill_gaps(face, border, triangles, nodes_, result_.deviation);
  if (triangles.empty() && gaps.triangles.empty() && gaps.joins.empty()) fail_at(face, region);
  if (!gaps.are_closed)
    throw DataError::at(source_, "body {} is not closed: the triangles of {} leave a gap at ({:g}, {:g}, {:g}){}",
                        number_of(region), title_of(face), gaps.place.x, gaps.place.y, gaps.place.z, way_out);
  for (const Vec3& p : gaps.nodes) {
    nodes_.push_back(p);
    same_.add();
  }
  tips_.insert(tips_.end(), gaps.joins.begin(), gaps.joins.end());
  triangles.insert(triangles.end(), gaps.triangles.begin(), gaps.triangles.end());
  result_.gap_triangles += gaps.triangles.size();
  result_.joined_nodes += gaps.joins.size();
  const int number = faces_.FindIndex(face);
  const bool turned = (face.Orientation() == TopAbs_REVERSED) != is_mirrored;
  const bool is_inside = face.Orientation() == TopAbs_INTERNAL;
  for (auto [a, b, c] : triangles) {
    if (turned) std::swap(b, c);
    done_[number].push_back(result_.surface.triangles.size());
    result_.surface.triangles.push_back({a, b, c});
    result_.surface.tags.push_back(tags_[number - 1]);
    result_.surface.sides.push_back({region, is_inside && !options_.open ? region : 0});
    face_of_triangle_.push_back(number);
  }
}

void Triangulator::fail_at(const TopoDS_Face& face, std::int32_t region) const {
  throw DataError::at(source_, "{} of body {}: OpenCASCADE cannot make triangles of it{}", title_of(face),
                      number_of(region), way_out);
}

void Triangulator::add_nodes(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangles,
                             const TopLoc_Location& place, std::int32_t first) {
  if (nodes_.size() + static_cast<std::size_t>(triangles->NbNodes()) > std::numeric_limits<std::int32_t>::max() / 3)
    throw DataError::at(source_, "its deviation {:g} asks for more triangles than can be numbered", result_.deviation);
  for (Standard_Integer i = 1; i <= triangles->NbNodes(); ++i) {
    const gp_Pnt p = triangles->Node(i).Transformed(place.Transformation());
    nodes_.push_back({p.X(), p.Y(), p.Z()});
    same_.add();
  }
  for (TopExp_Explorer part(face, TopAbs_EDGE); part.More(); part.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(part.Current());
    const auto polygon = BRep_Tool::PolygonOnTriangulation(edge, triangles, place);
    if (polygon.IsNull()) continue;
    std::vector<std::int32_t> nodes;
    for (Standard_Integer i = 1; i <= polygon->NbNodes(); ++i) nodes.push_back(first + polygon->Node(i) - 1);
    join_edge(edge, std::move(nodes));
  }
}

// `nodes` are those of one face at the edge, in the edge's own order.
void Triangulator::join_edge(const TopoDS_Edge& edge, std::vector<std::int32_t> nodes) {
  const auto join_vertex = [&](const TopoDS_Vertex& vertex, std::int32_t node) {
    if (vertex.IsNull()) return;
    auto& known = node_of_vertex_[vertex.TShape().get()];
    const auto found = std::ranges::find_if(known, [&](const auto& entry) { return entry.first.IsSame(vertex); });
    if (found == known.end())
      known.emplace_back(vertex, node);
    else
      same_.join(found->second, node);
  };
  TopoDS_Vertex begin, end;
  TopExp::Vertices(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), begin, end);
  join_vertex(begin, nodes.front());
  join_vertex(end, nodes.back());
  if (BRep_Tool::Degenerated(edge)) {
    for (const std::int32_t node : nodes) same_.join(node, nodes.front());
    return;
  }
  auto& known = nodes_of_edge_[faces_of_edge_.FindIndex(edge)];
  if (known.empty()) {
    known = std::move(nodes);
    return;
  }
  if (known.size() != nodes.size())
    throw DataError::at(source_, "edge {}: OpenCASCADE's triangles do not agree along it",
                        faces_of_edge_.FindIndex(edge));
  for (std::size_t i = 0; i < nodes.size(); ++i) same_.join(known[i], nodes[i]);
}

// When all faces have joined their nodes: the first of two goes where the second one is.
void Triangulator::close_tips() {
  for (const auto& [from, into] : tips_) {
    const Vec3 at = nodes_[same_.of(into)];
    same_.join(into, from);
    nodes_[same_.of(into)] = at;
  }
}

void Triangulator::add_curves() {
  result_.shape.edge_tags.assign(faces_of_edge_.Extent(), 0);
  for (const auto& [number, nodes] : nodes_of_edge_) {
    const TopoDS_Edge& edge = TopoDS::Edge(faces_of_edge_.FindKey(number));
    const TopTools_ListOfShape& faces = faces_of_edge_.FindFromIndex(number);
    const bool has_two_names = faces.Extent() == 2 && group_of(faces.First()) != group_of(faces.Last());
    if (!has_two_names && is_smooth(edge, faces)) continue;
    const auto tag = static_cast<std::int32_t>(++result_.curves);
    result_.shape.edge_tags[number - 1] = tag;
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const formats::CurveEdge ends{same_.of(nodes[i - 1]), same_.of(nodes[i])};
      if (ends[0] == ends[1]) continue;
      result_.surface.curves.push_back(ends);
      result_.surface.curve_tags.push_back(tag);
    }
    if (std::string name = model_.names.of(edge); !name.empty()) result_.surface.names.curves[tag] = std::move(name);
  }
}

// Triangles that have the same nodes as another one from the other side, of the same body: between the sides of a tip
// that became one, and of slivers whose nodes did.
std::vector<bool> Triangulator::flat_pairs() {
  const std::vector<Triangle>& triangles = result_.surface.triangles;
  std::vector<bool> is_flat(triangles.size());
  if (result_.joined_nodes == 0) return is_flat;
  std::map<Triangle, std::size_t> seen;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Triangle t = triangles[i];
    for (Vertex& v : t) v = same_.of(v);
    std::ranges::rotate(t, std::ranges::min_element(t));
    const auto other = seen.find({t[0], t[2], t[1]});
    if (other == seen.end() || result_.surface.sides[i] != result_.surface.sides[other->second]) {
      seen.emplace(t, i);
      continue;
    }
    is_flat[i] = is_flat[other->second] = true;
    seen.erase(other);
  }
  return is_flat;
}

// Nodes that are one become one point. Triangles with fewer than three points, which occur at poles, go, and so do
// walls inside, and pairs of triangles with nothing between them.
void Triangulator::number_points() {
  formats::SurfaceSoup& surface = result_.surface;
  const std::vector<bool> is_flat = flat_pairs();
  std::vector<Vertex> number(nodes_.size(), no_index);
  const auto number_of = [&](std::int32_t node) {
    Vertex& known = number[same_.of(node)];
    if (known == no_index) {
      known = static_cast<Vertex>(surface.points.size());
      surface.points.push_back(nodes_[same_.of(node)]);
    }
    return known;
  };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    Triangle t = surface.triangles[i];
    for (Vertex& v : t) v = same_.of(v);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || surface.sides[i] == std::array<std::int32_t, 2>{} || is_flat[i])
      continue;
    for (Vertex& v : t) v = number_of(v);
    surface.triangles[kept] = t;
    surface.tags[kept] = surface.tags[i];
    surface.sides[kept] = surface.sides[i];
    face_of_triangle_[kept++] = face_of_triangle_[i];
  }
  surface.triangles.resize(kept);
  surface.tags.resize(kept);
  surface.sides.resize(kept);
  face_of_triangle_.resize(kept);
  drop_curves_without_triangles(number);
  surface.places.resize(kept);
  std::iota(surface.places.begin(), surface.places.end(), 1);
}

// Drops the curves on walls inside.
void Triangulator::drop_curves_without_triangles(const std::vector<Vertex>& number) {
  formats::SurfaceSoup& surface = result_.surface;
  KeySet<2> edges;
  for (const auto& [a, b, c] : surface.triangles)
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) edges.insert(edge_key(from, to));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < surface.curves.size(); ++i) {
    const formats::CurveEdge ends{number[surface.curves[i][0]], number[surface.curves[i][1]]};
    if (ends[0] == no_index || ends[1] == no_index || !edges.contains(key_of(ends))) continue;
    surface.curves[kept] = ends;
    surface.curve_tags[kept++] = surface.curve_tags[i];
  }
  surface.curves.resize(kept);
  surface.curve_tags.resize(kept);
}

// Around each region, every edge has as many triangles in one direction as in the other.
void Triangulator::check_closed() const {
  const formats::SurfaceSoup& surface = result_.surface;
  struct Balance {
    int count = 0;
    int face = 0;
  };
  std::map<std::int32_t, KeyMap<2, Balance>> edges;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    for (int side = 0; side < 2; ++side) {
      const std::int32_t region = surface.sides[i][side];
      if (region == 0) continue;
      for (int k = 0; k < 3; ++k) {
        const Vertex a = surface.triangles[i][k], b = surface.triangles[i][(k + 1) % 3];
        Balance& balance = edges[region][edge_key(a, b)];
        balance.count += (a < b) == (side == 0) ? 1 : -1;
        balance.face = face_of_triangle_[i];
      }
    }
  for (const auto& [region, balances] : edges)
    for (const auto& [edge, balance] : balances)
      if (balance.count != 0) {
        const Vec3& p = surface.points[edge[0]];
        throw DataError::at(source_, "body {} is not closed: the triangles of {} leave a gap at ({:g}, {:g}, {:g}){}",
                            number_of(region), title_of(TopoDS::Face(faces_.FindKey(balance.face))), p.x, p.y, p.z,
                            way_out);
      }
}

void Triangulator::name_regions() {
  for (std::size_t body = 0; body < model_.bodies.size(); ++body)
    if (!model_.bodies[body].name.empty())
      result_.surface.names.regions[static_cast<std::int32_t>(body + 1)] = model_.bodies[body].name;
}

// With its triangles, so that what is near a triangle is found on the face itself at once.
void Triangulator::keep_shape() {
  std::ostringstream text;
  BRepTools::Write(whole_, text, Standard_True, Standard_False, TopTools_FormatVersion_CURRENT);
  result_.shape.brep = std::move(text).str();
  result_.shape.face_tags = tags_;
}

void Triangulator::find_crossings(Attempt& attempt) const {
  for (const auto& [one, other] : crossings_of_bodies(result_.surface)) {
    ++attempt.crossings;
    for (const std::int32_t t : {one, other}) attempt.crossing_faces.Add(faces_.FindKey(face_of_triangle_[t]));
  }
}

// The faces whose triangles go before others are made. Where those are coarser, faces that share edges with the
// crossing ones are among them, because points on edges stay as fine as any face beside them asks for.
TopTools_IndexedMapOfShape faces_to_clean(const Fineness& fineness, const TopTools_IndexedMapOfShape& faces,
                                          const TopoDS_Compound& whole) {
  if (!fineness.is_coarser()) return faces;
  TopTools_IndexedMapOfShape result = faces;
  if (fineness.angle > 1) {
    TopExp::MapShapes(whole, TopAbs_FACE, result);
    return result;
  }
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
  TopExp::MapShapesAndAncestors(whole, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
  for (int f = 1; f <= faces.Extent(); ++f)
    for (TopExp_Explorer edge(faces(f), TopAbs_EDGE); edge.More(); edge.Next())
      for (const TopoDS_Shape& beside : faces_of_edge.FindFromKey(edge.Current())) result.Add(beside);
  return result;
}

double tight_diagonal_of(const TopoDS_Compound& whole) {
  Bnd_Box box;
  BRepBndLib::AddOptimal(whole, box, Standard_False, Standard_False);
  return std::sqrt(box.SquareExtent());
}

// Nothing if OpenCASCADE fails at it.
std::optional<Attempt> attempt_anew(const CadModel& model, const TopoDS_Compound& whole,
                                    const TriangulationOptions& options, const Fineness& fineness, double deviation,
                                    const TopTools_IndexedMapOfShape& faces, const std::string& source) {
  try {
    for (int f = 1; f <= faces.Extent(); ++f) BRepTools::Clean(faces(f));
    mesh(whole, fineness.deviation * deviation, fineness.angle_of(options));
    return Triangulator(model, whole, options, std::max(1.0, fineness.deviation) * deviation, source).run();
  } catch (const Standard_Failure&) {
    return std::nullopt;
  } catch (const DataError&) {
    return std::nullopt;
  }
}

}  // namespace

double default_size_of(const CadModel& model) {
  const TopoDS_Compound whole = compound_of(model);
  GProp_GProps area, volume;
  BRepGProp::SurfaceProperties(whole, area);
  BRepGProp::VolumeProperties(whole, volume);
  const double diagonal = tight_diagonal_of(whole), thickness = 2 * std::abs(volume.Mass()) / std::abs(area.Mass());
  if (!(thickness > least_thickness * diagonal)) return size_of_diagonal * diagonal;
  return default_size({diagonal, std::abs(area.Mass()), std::abs(volume.Mass())},
                      std::numeric_limits<double>::infinity());
}

Triangulation triangulate(const CadModel& model, const TriangulationOptions& options, const std::string& source) {
  const TopoDS_Compound whole = compound_of(model);
  const double deviation = options.deviation.value_or(
      deviation_of_size * (options.open ? size_of_diagonal * tight_diagonal_of(whole) : default_size_of(model)));
  mesh(whole, deviation, options.angle);
  Attempt first = Triangulator(model, whole, options, deviation, source).run();
  if (first.crossings == 0) return std::move(first.made);

  first.made.made_anew.crossings = first.crossings;
  TopTools_IndexedMapOfShape crossing = first.crossing_faces;
  for (const Fineness& fineness : fineness_where_crossing) {
    if (fineness.deviation > 1 && options.deviation) continue;
    if (fineness.angle > 1 && options.angle != TriangulationOptions{}.angle) continue;
    if (!fineness.is_coarser() && first.made.surface.triangles.size() > most_triangles) continue;
    std::optional<Attempt> attempt =
        attempt_anew(model, whole, options, fineness, deviation, faces_to_clean(fineness, crossing, whole), source);
    if (!attempt) continue;
    attempt->made.made_anew = {first.crossings, true};
    if (attempt->crossings == 0) return std::move(attempt->made);
    crossing = attempt->crossing_faces;
  }
  first.made.made_anew.collapsed = collapse_short_edges(first.made.surface, deviation);
  return std::move(first.made);
}

}  // namespace hexpipe::tessellate
