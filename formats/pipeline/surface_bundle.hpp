#pragma once
// Surfaces in bundles: the members surface/*.npy and names.json.

#include <functional>
#include <string_view>

#include "formats/pipeline/bundle.hpp"
#include "formats/streams/input.hpp"
#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::pipeline {

bool is_surface_member(std::string_view name);

// Takes the surface and the names of a bundle. Passes each other member to `other`, if that is given, which may read
// it. `copy`, if not null, gets the members of the surface as they come. Points without a triangle and points equal to
// another one are left out, as for all formats.
formats::SurfaceSoup read_surface_bundle(formats::Input& input, const std::function<void(BundleReader&)>& other,
                                         BundleWriter* copy = nullptr);

// Takes the current member when it is one of the surface's, and also writes it to `copy` unless that is null.
bool read_surface_member(BundleReader& reader, formats::SurfaceSoup& surface, BundleWriter* copy);
// A surface taken in this way, checked and completed as by read_surface_bundle.
formats::SurfaceSoup checked_surface(formats::SurfaceSoup surface);

// Writes all members that have content, except the names.
void write_surface_members(BundleWriter& writer, const formats::SurfaceSoup& surface);

}  // namespace hexpipe::pipeline
