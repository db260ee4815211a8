#include "formats/streams/foreign_files.hpp"

#include <algorithm>

#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view begins;
  ForeignFile kind;
};

constexpr std::string_view unpack = "; unpack it first", by_converter = "; meshio or Gmsh can convert it",
                           by_modeller = "; export it as STL or OBJ", by_cad = "; export it as STEP or STL";

// By the bytes with which a file begins.
constexpr Signature binary_signatures[] = {
    {"BZh"sv, {"a file packed by bzip2", unpack}},
    {"\xfd"
     "7zXZ\0"sv,
     {"a file packed by xz", unpack}},
    {"7z\xbc\xaf\x27\x1c"sv, {"a 7z archive", unpack}},
    {"Rar!\x1a"sv, {"a RAR archive", unpack}},
    {"%PDF-"sv, {"a PDF document", ""}},
    {"%!PS"sv, {"a PostScript document", ""}},
    {"\x89PNG"sv, {"a PNG image", ""}},
    {"\xff\xd8\xff"sv, {"a JPEG image", ""}},
    {"GIF8"sv, {"a GIF image", ""}},
    {"\x7f"
     "ELF"sv,
     {"a program", ""}},
    {"glTF"sv, {"a binary glTF file (.glb)", by_modeller}},
    {"Kaydara FBX Binary"sv, {"an FBX file", by_modeller}},
    {"BLENDER"sv, {"a Blender file", by_modeller}},
    {"3D Geometry File Format"sv, {"a Rhino file (.3dm)", by_modeller}},
    {"PXR-USDC"sv, {"a USD file", by_modeller}},
    {"#usda"sv, {"a USD file", by_modeller}},
    {"Ogawa"sv, {"an Alembic file", by_modeller}},
    {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"sv,
     {"a file of Microsoft's compound format (SolidWorks, Inventor and others)", by_cad}},
    {"AC10"sv, {"an AutoCAD drawing (.dwg)", by_cad}},
    {"ACIS BinaryFile"sv, {"an ACIS file (.sab)", by_cad}},
    {"**ABCDEFGHIJKLMNOPQRSTUVWXYZ"sv, {"a Parasolid file (.x_t)", by_cad}},
    {"PS\0\0"sv, {"a Parasolid file (.x_b)", by_cad}},
    {"LASF"sv, {"a cloud of points (.las)", "; it has no triangles"}},
    {"\1\0\0\0"sv, {"MEDIT's binary format", "; transmesh of libmeshb makes a .mesh of it"}},
    {"\0\0\0\1"sv, {"MEDIT's binary format", "; transmesh of libmeshb makes a .mesh of it"}},
};

// By the words with which a text begins, capitals or not.
constexpr Signature text_signatures[] = {
    {"ISO-10303-21", {"CAD in STEP", "", true}},
    {"DBRep_DrawableShape", {"CAD in BREP", "", true}},
    {"CASCADE Topology", {"CAD in BREP", "", true}},
    {"version https://git-lfs", {"a pointer of Git LFS", "; 'git lfs pull' fetches the file itself"}},
    {"<!DOCTYPE html", {"a web page (HTML)", "; was a page saved in place of the file?"}},
    {"<html", {"a web page (HTML)", "; was a page saved in place of the file?"}},
    {"#VRML", {"a VRML file", by_modeller}},
    {"; FBX", {"an FBX file", by_modeller}},
    {"# .PCD", {"a cloud of points (.pcd)", "; it has no triangles"}},
    {"*KEYWORD", {"an LS-DYNA file", by_converter}},
    {"/PREP7", {"an Ansys file", by_converter}},
    {"/COM,", {"an Ansys file", by_converter}},
    {"mesh3d", {"a Netgen mesh (.vol)", "; Netgen exports it as Gmsh's .msh"}},
    {"xof 0", {"a DirectX file (.x)", by_modeller}},
    {"#Inventor", {"an Open Inventor file", by_modeller}},
    {"VARIABLES", {"a Tecplot file", by_converter}},
    {"FoamFile", {"a file of OpenFOAM", "; foamToVTK makes a .vtu of the case"}},
};

// By the first element of a text in XML.
constexpr Signature xml_signatures[] = {
    {"COLLADA", {"a COLLADA file (.dae)", by_modeller}},
    {"X3D", {"an X3D file", by_modeller}},
    {"amf", {"an AMF file", by_modeller}},
    {"model", {"the model of a 3MF file", by_modeller}},
    {"svg", {"a drawing in SVG", ""}},
    {"html", {"a web page (HTML)", "; was a page saved in place of the file?"}},
    {"febio_spec", {"a FEBio file", by_converter}},
    {"Xdmf", {"an XDMF file", by_converter}},
    {"dolfin", {"a DOLFIN mesh", by_converter}},
};

bool begins_with_any_case(std::string_view text, std::string_view begin) {
  return equal_ignoring_case(text.substr(0, begin.size()), begin);
}

template <std::size_t Size>
std::optional<ForeignFile> kind_among(const Signature (&signatures)[Size], std::string_view text) {
  for (const Signature& signature : signatures)
    if (begins_with_any_case(text, signature.begins)) return signature.kind;
  return std::nullopt;
}

// In the first bytes of a zip archive are the names of its first files.
ForeignFile kind_of_zip(std::string_view bytes) {
  constexpr std::size_t enough = 1 << 16;
  const std::string_view head = bytes.substr(0, enough);
  const auto has = [&](std::string_view name) { return head.find(name) != std::string_view::npos; };
  if (has("3D/3dmodel.model") || has("3dmodel")) return {"a 3MF file", "; tetmesh fills it with a mesh"};
  if (has("Document.xml")) return {"a FreeCAD file", "", true};
  if (has("word/") || has("xl/") || has("ppt/")) return {"an Office document", ""};
  return {"a zip archive", unpack};
}

std::string_view first_element(std::string_view text) {
  while (text.starts_with('<')) {
    if (text.size() > 1 && is_letter(text[1])) return text.substr(1);
    const std::string_view end = text.starts_with("<!--") ? "-->" : ">";
    const std::size_t found = text.find(end);
    if (found == std::string_view::npos) return {};
    text.remove_prefix(found + end.size());
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  }
  return {};
}

ForeignFile kind_of_json(std::string_view text) {
  constexpr std::size_t enough = 1 << 16;
  const std::string_view head = text.substr(0, enough);
  const bool is_gltf = head.find("\"asset\"") != std::string_view::npos && head.find("\"version\"") != head.npos;
  if (is_gltf || head.find("\"meshes\"") != std::string_view::npos) return {"a glTF file", by_modeller};
  return {"a text in JSON", ""};
}

// The column for the kind of a line, S in the first, and the number of the line.
bool is_iges(std::string_view text) {
  return text.size() > 80 && text.substr(0, 80).find_first_of("\r\n") == std::string_view::npos && text[72] == 'S' &&
         text.substr(73, 7).find_first_not_of(" 0") == 6 && text[79] == '1';
}

// "0" and "SECTION" on the first two lines.
bool is_dxf(std::string_view text) {
  TextScanner words(text.substr(0, 200), "");
  if (words.peek_word() != "0") return false;
  words.word("");
  return words.peek_word() == "SECTION";
}

// Data sets stand between lines of -1.
bool is_universal_file(std::string_view text) {
  TextScanner words(text.substr(0, 200), "");
  if (!text.starts_with("    -1") || words.peek_word() != "-1") return false;
  words.word("");
  const std::string_view number = words.peek_word();
  return !number.empty() && std::ranges::all_of(number, is_digit);
}

// The title of a Nastran file looks the same, but no variables come after it.
bool is_tecplot(std::string_view text) {
  constexpr std::size_t enough = 4096;
  return begins_with_any_case(text, "TITLE") && capitals(text.substr(0, enough)).find("VARIABLES") != std::string::npos;
}

// Sections in brackets, comments first: (0 "GAMBIT to Fluent File").
bool is_fluent(std::string_view text) {
  return text.size() > 2 && text[0] == '(' && is_digit(text[1]) &&
         (text[2] == ' ' || (is_digit(text[2]) && text.size() > 3 && text[3] == ' '));
}

}  // namespace

std::optional<ForeignFile> kind_of_foreign_file(std::string_view bytes) {
  for (const Signature& signature : binary_signatures)
    if (bytes.starts_with(signature.begins)) return signature.kind;
  if (bytes.starts_with("PK\3\4") || bytes.starts_with("PK\5\6")) return kind_of_zip(bytes);
  if (is_iges(bytes)) return ForeignFile{"CAD in IGES", "", true};
  if (is_universal_file(bytes)) return ForeignFile{"a universal file (I-deas .unv)", by_converter};
  if (is_dxf(bytes)) return ForeignFile{"a drawing in DXF", by_cad};
  const std::string_view text = bytes.substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  if (auto kind = kind_among(text_signatures, text)) return kind;
  if (text.starts_with('<'))
    if (auto kind = kind_among(xml_signatures, first_element(text))) return kind;
  if (is_tecplot(text)) return ForeignFile{"a Tecplot file", by_converter};
  if (is_fluent(text)) return ForeignFile{"a Fluent mesh", "; Fluent and Gmsh export other formats"};
  if (text.starts_with('{') || text.starts_with("[{")) return kind_of_json(text);
  return std::nullopt;
}

}  // namespace hexpipe::formats
