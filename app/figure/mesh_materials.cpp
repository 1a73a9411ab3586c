#include "app/figure/mesh_materials.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

#include "app/figure/uri_files.h"
#include "app/files/errors.h"
#include "app/files/image_io.h"
#include "app/files/text_file.h"

namespace app {
namespace {

constexpr int kMaxMaterialSide = 1024;  // texels
constexpr int kMaxPictureSide = 8192;   // pixels
constexpr std::size_t kMaxTexels = std::size_t{16} << 20;

// sRGB's curve (IEC 61966-2-1).
float encoded(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}
float decoded(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

struct BaseColor {
  std::array<float, 3> linear{1, 1, 1};
  std::optional<Image> picture;
};

std::array<float, 3> factorOf(const aiMaterial& material, std::vector<std::string>& notes) {
  aiColor4D color(1, 1, 1, 1);
  const bool is_linear = material.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS;
  if (!is_linear && material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != AI_SUCCESS) return {1, 1, 1};
  std::array<float, 3> linear{color.r, color.g, color.b};
  if (std::ranges::any_of(linear, [](float c) { return !(c >= 0 && c <= 1); }))
    notes.push_back("material '" + std::string(material.GetName().C_Str()) +
                    "': its colour is not within 0 and 1 and is brought there; export the figure again");
  for (float& c : linear) {
    c = std::isfinite(c) ? std::clamp(c, 0.0f, 1.0f) : 1.0f;
    if (!is_linear) c = decoded(c);
  }
  return linear;
}

// A picture that assimp has unpacked: blue first.
Image unpacked(const aiTexture& texture) {
  Image image{static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), {}};
  for (std::size_t t = 0; t < std::size_t{texture.mWidth} * texture.mHeight; ++t) {
    const aiTexel& texel = texture.pcData[t];
    image.rgba.insert(image.rgba.end(), {texel.r, texel.g, texel.b, texel.a});
  }
  return image;
}

// Throws InputError.
Image readPicture(const aiScene& scene, const std::string& file, const aiString& path) {
  if (const aiTexture* inside = scene.GetEmbeddedTexture(path.C_Str())) {
    if (inside->mHeight > 0) return unpacked(*inside);
    return readPictureBytes({reinterpret_cast<const char*>(inside->pcData), inside->mWidth}, path.C_Str(),
                            kMaxPictureSide);
  }
  std::string name = path.C_Str();
  std::replace(name.begin(), name.end(), '\\', '/');
  const std::string beside = fileOfUri((std::filesystem::path(file).parent_path() / name).string());
  return readPictureBytes(readText(beside), beside, kMaxPictureSide);
}

BaseColor readMaterial(const aiScene& scene, const std::string& file, const aiMaterial& material,
                       std::vector<std::string>& notes) {
  BaseColor base{factorOf(material, notes), std::nullopt};
  aiString path;
  if (material.GetTexture(aiTextureType_BASE_COLOR, 0, &path) != AI_SUCCESS &&
      material.GetTexture(aiTextureType_DIFFUSE, 0, &path) != AI_SUCCESS) {
    return base;
  }
  try {
    base.picture = readPicture(scene, file, path);
  } catch (const InputError& error) {
    notes.push_back("material '" + std::string(material.GetName().C_Str()) +
                    "' is shown without its picture: " + error.what());
  }
  return base;
}

// The mean of the picture's texels under one texel of the stack, each channel as stored, times the colour.
std::uint32_t texelAt(const BaseColor& base, int side, int x, int y) {
  std::array<float, 3> sum{1, 1, 1};
  if (base.picture) {
    const Image& image = *base.picture;
    const auto range = [side](int at, int size) {
      const int begin = static_cast<int>(std::int64_t{at} * size / side);
      return std::pair(begin, std::max(begin + 1, static_cast<int>(std::int64_t{at + 1} * size / side)));
    };
    const auto [left, right] = range(x, image.width);
    const auto [top, bottom] = range(y, image.height);
    sum = {0, 0, 0};
    for (int v = top; v < bottom; ++v) {
      for (int u = left; u < right; ++u) {
        const unsigned char* texel = &image.rgba[4 * (static_cast<std::size_t>(v) * image.width + u)];
        for (std::size_t k = 0; k < 3; ++k) sum[k] += texel[k];
      }
    }
    for (float& s : sum) s /= 255.0f * static_cast<float>((right - left) * (bottom - top));
  }
  std::uint32_t texel = 0xff000000u;
  for (std::size_t k = 0; k < 3; ++k) {
    const float value = encoded(base.linear[k] * decoded(sum[k]));
    texel |= static_cast<std::uint32_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f))) << (8 * k);
  }
  return texel;
}

int sideFor(const std::vector<BaseColor>& colors) {
  int largest = 1;
  for (const BaseColor& base : colors) {
    if (base.picture) largest = std::max({largest, base.picture->width, base.picture->height});
  }
  int side = 1;
  while (side < std::min(largest, kMaxMaterialSide)) side *= 2;
  while (side > 1 && static_cast<std::size_t>(side) * side * colors.size() > kMaxTexels) side /= 2;
  return side;
}

bool isPlain(const BaseColor& base) {
  constexpr float kColorful = 0.02f;
  const auto [low, high] = std::minmax_element(base.linear.begin(), base.linear.end());
  return !base.picture && *high - *low < kColorful;
}

}  // namespace

void MaterialList::appendPlace(const aiMesh& mesh, unsigned vertex, SkinnedMesh& into) {
  const auto found = std::find(used_.begin(), used_.end(), mesh.mMaterialIndex);
  const auto number = found - used_.begin();
  if (found == used_.end()) used_.push_back(mesh.mMaterialIndex);
  Eigen::Vector3f place(0, 0, static_cast<float>(number));
  if (mesh.HasTextureCoords(0)) {
    const aiVector3D& at = mesh.mTextureCoords[0][vertex];
    if (std::isfinite(at.x) && std::isfinite(at.y)) place.head<2>() = Eigen::Vector2f(at.x, 1 - at.y);
  }
  into.material_places.push_back(place);
}

void MaterialList::fill(const aiScene& scene, const std::string& file, SkinnedMesh& into,
                        std::vector<std::string>& notes) const {
  std::vector<BaseColor> colors;
  for (const unsigned index : used_) {
    colors.push_back(index < scene.mNumMaterials ? readMaterial(scene, file, *scene.mMaterials[index], notes)
                                                 : BaseColor{});
  }
  if (std::all_of(colors.begin(), colors.end(), isPlain)) {
    into.material_places.clear();
    return;
  }
  const int side = sideFor(colors);
  for (const BaseColor& base : colors) {
    std::vector<std::uint32_t>& picture = into.materials.emplace_back();
    picture.reserve(static_cast<std::size_t>(side) * side);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) picture.push_back(texelAt(base, side, x, y));
    }
  }
  const auto pictures =
      std::count_if(colors.begin(), colors.end(), [](const BaseColor& c) { return c.picture.has_value(); });
  notes.push_back("materials: " + std::to_string(colors.size()) + ", " + std::to_string(pictures) +
                  " with a picture; body_color is not used (own_materials 0: it is)");
}

}  // namespace app
