#include "app/files/hair_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <span>
#include <unordered_map>
#include <utility>

#include "app/files/errors.h"
#include "app/files/obj_layers.h"

namespace app {
namespace {

constexpr double kSmallestHair = 0.002;  // m

std::string layerName(int layer) {
  return "layer_" + std::to_string(layer);
}

// Puts the faces of all layers over one another: which face of a layer belongs to which bundle, which vertex to which
// column.
struct Stacker {
  const std::string& file;
  const ObjLayers& obj;
  std::vector<std::vector<const ObjFace*>> bundles = {};  // per root face: its face in every layer that it reaches
  std::vector<int> column_of = {}, layer_of = {};         // per OBJ vertex; -1: no face has named it yet
  std::vector<std::vector<int>> columns = {};             // OBJ vertices, root first
  std::vector<sim::RootFace> root_faces = {};

  [[noreturn]] void fail(int line, const std::string& fault, const std::string& mend) const {
    throw InputError(file, "line " + std::to_string(line), fault, mend);
  }
  void checkLayers() const;
  void stackBundles();
  void stackByName(const ObjLayer& layer, int number, const std::unordered_map<std::string_view, int>& names);
  void stackByOrder(const ObjLayer& layer, int number);
  void addToBundle(int bundle, int number, const ObjFace& face);
  void rootColumns();
  void growColumns();
  void checkUse() const;
  sim::HairMeshShape shape() const;
  std::vector<ColumnShare> shares() const;
  std::string placeOf(const std::string& place) const;
};

void Stacker::checkLayers() const {
  if (obj.layers.empty() || obj.layers.begin()->first != 0)
    throw InputError(file, "", "it has no layer_0, the scalp",
                     "group the root faces under 'g layer_0'; of curves and cards hairmesh-convert makes such a file");
  int expected = 0;
  for (const auto& [number, layer] : obj.layers) {
    if (number != expected)
      fail(layer.line, layerName(number) + " dangles: there is no " + layerName(expected),
           "number the layers without gaps");
    if (layer.faces.empty())
      fail(layer.line, layerName(number) + " has no faces",
           "give it the faces of the bundles that reach it, or leave it out");
    ++expected;
  }
  if (expected < 2)
    fail(obj.layers.begin()->second.line, "layer_0 is the only layer", "extrude it at least once, into layer_1");
}

bool allNamed(const ObjLayer& layer) {
  return std::all_of(layer.faces.begin(), layer.faces.end(), [](const ObjFace& f) { return !f.bundle.empty(); });
}

void Stacker::addToBundle(int bundle, int number, const ObjFace& face) {
  std::vector<const ObjFace*>& stack = bundles[bundle];
  if (static_cast<int>(stack.size()) > number)
    fail(face.line, "the bundle " + std::string(face.bundle) + " has two faces in " + layerName(number),
         "keep one of them");
  if (static_cast<int>(stack.size()) < number)
    fail(face.line, "the face dangles: its bundle has none in " + layerName(number - 1),
         "a bundle reaches every layer up to its last");
  if (stack.front()->corner_count != face.corner_count)
    fail(face.line,
         "the face has another number of corners than its root face on line " + std::to_string(stack.front()->line),
         "keep the corners of a bundle's faces the same");
  stack.push_back(&face);
}

void Stacker::stackByName(const ObjLayer& layer, int number, const std::unordered_map<std::string_view, int>& names) {
  for (const ObjFace& face : layer.faces) {
    const auto found = names.find(face.bundle);
    if (found == names.end())
      fail(face.line, "the face dangles: layer_0 has no bundle of the name " + std::string(face.bundle.substr(0, 40)),
           "name it as its root face is named");
    addToBundle(found->second, number, face);
  }
}

void Stacker::stackByOrder(const ObjLayer& layer, int number) {
  if (layer.faces.size() != bundles.size())
    fail(layer.line,
         layerName(number) + " has " + std::to_string(layer.faces.size()) + " faces where layer_0 has " +
             std::to_string(bundles.size()) + ", and they are not named",
         "keep all faces in the same order, or put 'usemtl bundle_<n>' before each face of every layer");
  for (std::size_t i = 0; i < layer.faces.size(); ++i) addToBundle(static_cast<int>(i), number, layer.faces[i]);
}

void Stacker::stackBundles() {
  const ObjLayer& roots = obj.layers.at(0);
  std::unordered_map<std::string_view, int> names;
  const bool named = allNamed(roots);
  for (const ObjFace& face : roots.faces) {
    if (named && !names.emplace(face.bundle, static_cast<int>(bundles.size())).second)
      fail(face.line, "a second root face is named " + std::string(face.bundle.substr(0, 40)),
           "give every root face its own name");
    bundles.push_back({&face});
  }
  for (const auto& [number, layer] : obj.layers) {
    if (number == 0) continue;
    if (named && allNamed(layer)) {
      stackByName(layer, number, names);
    } else {
      stackByOrder(layer, number);
    }
  }
}

// Columns are numbered in the order of the scalp's vertices.
void Stacker::rootColumns() {
  column_of.assign(obj.positions.size(), -1);
  layer_of.assign(obj.positions.size(), -1);
  for (const auto& bundle : bundles)
    for (int k = 0; k < bundle.front()->corner_count; ++k) layer_of[bundle.front()->v[k]] = 0;
  for (std::size_t v = 0; v < layer_of.size(); ++v) {
    if (layer_of[v] != 0) continue;
    column_of[v] = static_cast<int>(columns.size());
    columns.push_back({static_cast<int>(v)});
  }
  for (const auto& bundle : bundles) {
    sim::RootFace root{bundle.front()->corner_count, {-1, -1, -1, -1}};
    for (int k = 0; k < root.corner_count; ++k) root.columns[k] = column_of[bundle.front()->v[k]];
    root_faces.push_back(root);
  }
}

void Stacker::growColumns() {
  const int layers = static_cast<int>(obj.layers.size());
  for (int l = 1; l < layers; ++l) {
    for (std::size_t b = 0; b < bundles.size(); ++b) {
      if (static_cast<int>(bundles[b].size()) <= l) continue;
      const ObjFace& face = *bundles[b][l];
      for (int k = 0; k < face.corner_count; ++k) {
        const int v = face.v[k], c = root_faces[b].columns[k];
        std::vector<int>& column = columns[c];
        if (static_cast<int>(column.size()) == l && layer_of[v] < 0) {
          column.push_back(v);
          layer_of[v] = l;
          column_of[v] = c;
        } else if (static_cast<int>(column.size()) <= l || column[l] != v) {
          fail(face.line,
               "the face's vertex " + std::to_string(v + 1) + " does not stand over corner " + std::to_string(k + 1) +
                   " of its root face on line " + std::to_string(bundles[b].front()->line),
               "weld the layer's vertices and keep the order of faces and corners of layer_0");
        }
      }
    }
  }
}

void Stacker::checkUse() const {
  for (std::size_t v = 0; v < layer_of.size(); ++v) {
    if (layer_of[v] < 0)
      fail(obj.position_lines[v], "the vertex dangles: no face uses it", "remove it, or add the face that is missing");
  }
  for (std::size_t b = 0; b < bundles.size(); ++b) {
    std::size_t reach = columns[root_faces[b].columns[0]].size();
    for (int k = 1; k < root_faces[b].corner_count; ++k)
      reach = std::min(reach, columns[root_faces[b].columns[k]].size());
    if (reach != bundles[b].size())
      fail(bundles[b].back()->line,
           "the bundle ends in " + layerName(static_cast<int>(bundles[b].size()) - 1) +
               " though all its columns go on to " + layerName(static_cast<int>(reach) - 1),
           "let it go on as well, or give it a column that ends with it");
  }
}

sim::HairMeshShape Stacker::shape() const {
  sim::HairMeshShape out;
  out.root_faces = root_faces;
  for (const std::vector<int>& column : columns) {
    for (const int v : column) out.positions.push_back(obj.positions[v]);
    for (const int v : column)
      if (!obj.offsets.empty()) out.groom_offsets.push_back(obj.offsets[v]);
    out.column_first.push_back(static_cast<int>(out.positions.size()));
  }
  return out;
}

std::vector<ColumnShare> Stacker::shares() const {
  std::vector<ColumnShare> out;
  for (const std::vector<int>& column : columns) {
    if (obj.shares.empty()) break;
    const Eigen::Vector4d& of = obj.shares[column.front()];
    out.push_back({of[0], of[1], of[2], of[3]});
  }
  return out;
}

// The line of the element that sim::MeshError names as "root face 3, layer 2, ..." or "column 4, layer 1".
std::string Stacker::placeOf(const std::string& place) const {
  const auto numberAfter = [&](std::string_view word) {
    const std::size_t at = place.find(word);
    int value = -1;
    if (at != std::string::npos) std::from_chars(place.data() + at + word.size(), place.data() + place.size(), value);
    return value;
  };
  const int face = numberAfter("root face "), column = numberAfter("column "),
            layer = std::max(0, numberAfter("layer "));
  int line = 0;
  if (face >= 0 && face < static_cast<int>(bundles.size()) && layer < static_cast<int>(bundles[face].size())) {
    line = bundles[face][layer]->line;
  } else if (column >= 0 && column < static_cast<int>(columns.size()) &&
             layer < static_cast<int>(columns[column].size())) {
    line = obj.position_lines[columns[column][layer]];
  }
  return line > 0 ? "line " + std::to_string(line) + " (" + place + ")" : place;
}

void append(std::string& text, double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  text.push_back(' ');
  text.append(digits, error == std::errc() ? end : digits);
}

void appendLine(std::string& text, const char* keyword, std::span<const double> values) {
  text += keyword;
  for (const double value : values) append(text, value);
  text += "\n";
}

void appendLine(std::string& text, const char* keyword, const sim::Vec3& values) {
  appendLine(text, keyword, std::span(values.data(), 3));
}

// The width's share only where it is not 1: programs that know three read the others.
void appendShare(std::string& text, const ColumnShare& share) {
  const std::array values{share.clump, share.curl, share.frizz, share.width};
  appendLine(text, "#look_share", std::span(values).first(share.width == 1 ? 3 : 4));
}

void reverse(sim::HairMeshShape& shape) {
  for (sim::RootFace& face : shape.root_faces)
    std::reverse(face.columns.begin(), face.columns.begin() + face.corner_count);
}

bool validReversed(sim::HairMeshShape shape) {
  reverse(shape);
  try {
    sim::buildHairMesh(shape);
  } catch (const sim::MeshError&) {
    return false;
  }
  return true;
}

// A hair mesh of a few millimetres was written in kilometres, or in another unit that no head is measured in.
void checkSize(const sim::HairMeshShape& shape, const std::string& file) {
  if (shape.positions.empty()) return;
  sim::Vec3 low = shape.positions.front(), high = low;
  for (const sim::Vec3& p : shape.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high - low).maxCoeff();
  if (size >= kSmallestHair || size == 0) return;
  char text[120];
  std::snprintf(text, sizeof text, "all of it is %.2g mm in size, read in metres", 1e3 * size);
  throw InputError(file, "", text,
                   size > 1e-5 && size < 2e-3 ? "it looks like kilometres: scale it by 1000" : "scale it to metres");
}

}  // namespace

sim::HairMeshShape readHairMesh(std::string_view text, const std::string& file, bool reverse_faces,
                                const char* reverse_switch, bool* turned, std::vector<ColumnShare>* shares) {
  const ObjLayers obj = readObjLayers(text, file);
  Stacker stacker{file, obj};
  stacker.checkLayers();
  stacker.stackBundles();
  stacker.rootColumns();
  stacker.growColumns();
  stacker.checkUse();
  sim::HairMeshShape shape = stacker.shape();
  if (shares) *shares = stacker.shares();
  if (reverse_faces) reverse(shape);
  checkSize(shape, file);
  try {
    sim::buildHairMesh(shape);
  } catch (const sim::MeshError& error) {
    if (validReversed(shape)) {
      if (turned) {
        *turned = true;
        reverse(shape);
        return shape;
      }
      throw InputError(file, "", "all faces are wound the other way",
                       (reverse_faces ? "leave out " : "reverse the faces, or give ") + std::string(reverse_switch));
    }
    throw InputError(file, stacker.placeOf(error.place), error.fault, error.mend);
  }
  return shape;
}

std::string writeHairMesh(const sim::HairMeshShape& shape, std::span<const ColumnShare> shares) {
  std::string text =
      "# Hair mesh: one group a layer, layer_0 is the scalp. Metres, y up, z to the front of the head.\n"
      "# usemtl bundle_<n> names the bundle that a face belongs to.\n";
  int layers = 0;
  for (int c = 0; c < shape.columnCount(); ++c) layers = std::max(layers, shape.columnLength(c));
  std::vector<int> number(shape.positions.size(), 0);  // in the file, from 1
  int written = 0;
  for (int l = 0; l < layers; ++l) {
    text += "g " + layerName(l) + "\n";
    for (int c = 0; c < shape.columnCount(); ++c) {
      if (l >= shape.columnLength(c)) continue;
      const int v = shape.column_first[c] + l;
      number[v] = ++written;
      appendLine(text, "v", shape.positions[v]);
      if (!shape.groom_offsets.empty() && !shape.groom_offsets[v].isZero(0))
        appendLine(text, "#groom_offset", shape.groom_offsets[v]);
      if (l == 0 && !shares.empty()) appendShare(text, shares[c]);
    }
    for (std::size_t f = 0; f < shape.root_faces.size(); ++f) {
      const sim::RootFace& face = shape.root_faces[f];
      bool reaches = true;
      for (int k = 0; k < face.corner_count; ++k) reaches = reaches && l < shape.columnLength(face.columns[k]);
      if (!reaches) continue;
      text += "usemtl bundle_" + std::to_string(f) + "\nf";
      for (int k = 0; k < face.corner_count; ++k)
        text.append(" ").append(std::to_string(number[shape.column_first[face.columns[k]] + l]));
      text += "\n";
    }
  }
  return text;
}

}  // namespace app
