#pragma once
// Makes a scene of what a stage of the pipeline has.

#include <string>

#include "formats/pipeline/stage_data.hpp"
#include "formats/streams/input.hpp"
#include "tools/viewmesh/scene.hpp"

namespace hexpipe::viewmesh {

// The last one in the input of mesh, candidates, solution and result. Throws DataError naming `source` when there is
// none, there are no cells, or candidates come without the mesh that has their points.
Scene::Content last_content(const pipeline::StageData& data, const std::string& source);
Scene make_scene(pipeline::StageData data, Scene::Content content, const std::string& source);

// Gives the scene the fragments of a text, whose lines have the candidates of one fragment each, counted from 1. It
// finds them by Scene::number among hexes, prisms and pyramids. Throws FormatError at a number that is not a
// candidate's.
void read_fragments(Scene& scene, formats::Input& input);

}  // namespace hexpipe::viewmesh
