#include "tools/tetmesh/statistics.hpp"

#include <utility>

namespace hexpipe::tetmesh {

StepSeconds& StepSeconds::operator+=(const StepSeconds& other) {
  checking += other.checking;
  remeshing += other.remeshing;
  placing += other.placing;
  tetgen += other.tetgen;
  building += other.building;
  comparing += other.comparing;
  improving += other.improving;
  of_tetgen += other.of_tetgen;
  return *this;
}

nlohmann::ordered_json to_json(const TetmeshStatistics& s) {
  nlohmann::ordered_json json{{"size", s.size},
                              {"surface_points", s.surface_points},
                              {"surface_triangles", s.surface_triangles},
                              {"surface_remeshed", s.remeshed},
                              {"surfaces_tried", s.surfaces_tried},
                              {"distance_to_input", s.distance_to_input},
                              {"distance_from_input", s.distance_from_input},
                              {"extra_points", s.extra_points},
                              {"short_features", s.short_features},
                              {"shells", s.shells},
                              {"regions", s.regions},
                              {"points_kept", name_of(s.points_kept)},
                              {"interior_points", s.interior_points},
                              {"added_points", s.added_points},
                              {"dropped_points", s.dropped_points},
                              {"tetgen_runs", s.tetgen_runs},
                              {"points", s.points},
                              {"tets", s.tets},
                              {"volume", s.volume},
                              {"least_dihedral", s.least_dihedral},
                              {"greatest_dihedral", s.greatest_dihedral}};
  if (s.row_ends) json["row_ends"] = *s.row_ends;
  if (s.dislocations)
    json["dislocations"] = {{"length", s.dislocations->all},
                            {"at_singularities", s.dislocations->at_singularities},
                            {"closed", s.dislocations->closed},
                            {"surface_ends", s.dislocations->surface_ends}};
  if (s.least_size) json["least_size"] = *s.least_size;
  if (s.repair) json["repair"] = solid::to_json(*s.repair);
  if (s.united_bodies) json["united_bodies"] = *s.united_bodies;
  if (s.lattice_hex_share)
    json["estimated_hex_share"] = {{"lattice", *s.lattice_hex_share}, {"frame", *s.frame_hex_share}};
  if (s.mixed_hex_share) json["estimated_hex_share"]["mixed"] = *s.mixed_hex_share;
  if (s.improved)
    json["improved"] = {{"rounds", s.improved->rounds},
                        {"changes", s.improved->changes},
                        {"estimated_hex_share_before", s.improved->share_before},
                        {"estimated_hex_share", s.improved->share}};
  auto tried = nlohmann::ordered_json::array();
  for (const auto& [size, share] : s.tried)
    tried.push_back({{"size", size}, {"estimated_hex_share", share ? nlohmann::ordered_json(*share) : nullptr}});
  if (!tried.empty()) json["tried"] = std::move(tried);
  return json;
}

nlohmann::ordered_json times_of(const TetmeshStatistics& statistics) {
  const StepSeconds& s = statistics.seconds;
  return {{"checking", s.checking}, {"remeshing", s.remeshing}, {"placing", s.placing},    {"tetgen", s.tetgen},
          {"building", s.building}, {"comparing", s.comparing}, {"improving", s.improving}};
}

}  // namespace hexpipe::tetmesh
