#include "tools/tessellate/freecad.hpp"

#include <fmt/format.h>

#include <BRep_Builder.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <filesystem>
#include <gp_Trsf.hxx>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "common/run/error.hpp"
#include "formats/streams/foreign_files.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/text_scanner.hpp"
#include "tools/tessellate/freecad_document.hpp"
#include "tools/tessellate/occt_names.hpp"

namespace hexpipe::tessellate {
namespace {

// Groups and links may lead in a circle, and double at each level.
constexpr int most_levels = 32;
constexpr std::size_t most_visits = 100'000;

// Walks down groups and links. `around` is the placement of all that an object is in; its own one comes first.
class FreecadReader {
 public:
  FreecadReader(const std::string& bytes, const std::string& name, const std::string& path)
      : document_(documents_.try_emplace(key_of(path), bytes, name, path).first->second) {}

  CadModel read(bool needs_bodies, TopoDS_Shape& whole) {
    visit_roots();
    if (model_.bodies.empty() && needs_bodies) take_hidden();
    whole = whole_;
    for (const auto& [what, reason] : left_out_)
      model_.warnings.push_back(fmt::format("{} is left out: {}", what, reason));
    return std::move(model_);
  }

 private:
  static std::string key_of(const std::string& path) {
    std::error_code ignored;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(path, ignored);
    return whole.empty() ? path : whole.string();
  }

  const FreecadDocument& linked(const FreecadDocument& from, const FreecadObject& link) {
    const std::string path = (std::filesystem::path(from.path()).parent_path() / link.target_file).string();
    const std::string key = key_of(path);
    if (const auto known = documents_.find(key); known != documents_.end()) return known->second;
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
      throw DataError::at(from.name(), "expected {}, to which the link '{}' leads, found no such file", path,
                          link.label);
    formats::Input input = formats::Input::open(path);
    return documents_.try_emplace(key, input.read_all(), path, path).first->second;
  }

  void visit_roots() {
    model_.bodies.clear();
    builder_.MakeCompound(whole_);
    for (const std::string& id : document_.roots()) visit(document_, id, gp_Trsf(), 0);
  }

  void take_hidden() {
    const TopoDS_Compound shown = whole_;
    takes_hidden_ = true;
    visit_roots();
    if (model_.bodies.empty())
      whole_ = shown;
    else
      model_.warnings.push_back("the document shows no solid; hidden ones are taken");
  }

  bool is_shown(const FreecadDocument& document, const std::string& id, const FreecadObject& object) const {
    if (takes_hidden_) return !document.is_operand(id);
    return (object.is_shown || object.is_plain_group()) && (document.has_views() || !document.is_operand(id));
  }

  void visit(const FreecadDocument& document, const std::string& id, const gp_Trsf& around, int level) {
    const FreecadObject* object = document.find(id);
    if (object != nullptr && is_shown(document, id, *object))
      show(document, *object, object->label, around, object->placement.value_or(gp_Trsf()), false, level);
  }

  // `own` takes the place of the object's own placement if it is `replaced`.
  void show(const FreecadDocument& document, const FreecadObject& object, const std::string& label,
            const gp_Trsf& around, const gp_Trsf& own, bool is_replaced, int level) {
    if (level > most_levels)
      throw DataError::at(document.name(), "expected at most {} levels of groups and links, found more at '{}'",
                          most_levels, label);
    if (++visits_ > most_visits)
      throw DataError::at(document.name(), "expected at most {} objects in groups and links, found more at '{}'",
                          most_visits, label);
    if (!object.target.empty()) return follow(document, object, around * own, level);
    if (!object.shape_file.empty()) return add(document, object, label, around, own, is_replaced);
    for (const std::string& member : object.members)
      if (!object.is_plain_group() || !document.is_in_part(member)) visit(document, member, around * own, level + 1);
  }

  // A link shows its target even where that is hidden.
  void follow(const FreecadDocument& document, const FreecadObject& link, const gp_Trsf& here, int level) {
    const auto leave_out = [&](const char* reason) {
      left_out_.emplace(fmt::format("the link '{}'", link.label), reason);
    };
    if (link.is_scaled) return leave_out("it scales its target");
    if (!link.target_part.empty()) return leave_out("it leads to a part of its target");
    const std::size_t members = link.is_array ? link.members.size() : 0;
    for (std::size_t i = 0; i < members; ++i)
      if (const FreecadObject* member = document.find(link.members[i]); member != nullptr && link.shows(i, members))
        show(document, *member, link.label, here, member->placement.value_or(gp_Trsf()), false, level + 1);
    if (members > 0) return;
    const FreecadDocument& there = link.target_file.empty() ? document : linked(document, link);
    const FreecadObject* target = there.find(link.target);
    if (target == nullptr)
      throw DataError::at(document.name(), "expected the object {}, to which the link '{}' leads, found none",
                          formats::quote_found(link.target), link.label);
    const gp_Trsf own = link.adds_to_targets_place && target->placement ? *target->placement : gp_Trsf();
    const std::vector<gp_Trsf> places = link.is_array ? document.places_of(link) : std::vector<gp_Trsf>(1);
    for (std::size_t i = 0; i < places.size(); ++i)
      if (!link.is_array || link.shows(i, places.size()))
        show(there, *target, link.label, here * places[i], own, true, level + 1);
  }

  // A shape is stored at the object's own placement.
  void add(const FreecadDocument& document, const FreecadObject& object, const std::string& label,
           const gp_Trsf& around, const gp_Trsf& own, bool is_replaced) {
    TopoDS_Shape shape = document.shape_of(object);
    if (shape.IsNull()) return;
    if (is_replaced) shape.Location(TopLoc_Location(own));
    if (around.Form() != gp_Identity) shape.Move(TopLoc_Location(around));
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    for (const auto& [number, name] : document.face_names_of(object, faces.Extent()))
      if (number >= 1 && number <= faces.Extent()) model_.names.set(faces(number), cad_name(name));
    for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
      model_.bodies.push_back({solid.Current(), cad_name(label)});
    if (faces.Extent() > 0) builder_.Add(whole_, shape);
  }

  std::map<std::string, FreecadDocument> documents_;  // by path
  const FreecadDocument& document_;
  CadModel model_;
  BRep_Builder builder_;
  TopoDS_Compound whole_;
  bool takes_hidden_ = false;
  std::size_t visits_ = 0;
  std::map<std::string, const char*> left_out_;
};

}  // namespace

bool looks_like_freecad(std::string_view bytes) {
  const auto kind = formats::kind_of_foreign_file(bytes);
  return kind && kind->is_cad && bytes.starts_with("PK");
}

CadModel read_freecad(const std::string& bytes, const std::string& name, const std::string& path, bool needs_bodies,
                      TopoDS_Shape& whole) {
  return FreecadReader(bytes, name, path).read(needs_bodies, whole);
}

}  // namespace hexpipe::tessellate
