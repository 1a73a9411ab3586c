// Draws the pictures of the presets that the panels show: one a frame, while nothing is more urgent, and again when
// what they depend on has changed.
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/view/preset_picture.h"
#include "app/ui/ui.h"
#include "render/gl/render_target.h"
#include "render/renderer.h"

namespace app {

class PresetPictures {
 public:
  // `waits`: a frame waits for what is simulated beside it, so that every run shows the same.
  PresetPictures(std::string shader_dir, bool waits);
  ~PresetPictures();
  PresetPictures(const PresetPictures&) = delete;
  PresetPictures& operator=(const PresetPictures&) = delete;

  // Goes on with the pictures that ui.presets_in_sight asks for, and puts them into ui.preset_pictures. Answers whether
  // more is to come. Needs the current OpenGL context.
  bool work(const Demo& demo, UiState& ui);

 private:
  struct Picture {
    std::string file;
    PictureSubject subject;  // that it shows
    std::filesystem::file_time_type written{};
    render::ImageTarget image;
    bool faulty = false;
  };
  // The one that is being made.
  struct Coming {
    std::string file;
    PictureSubject subject;
    PresetScene preset;
    std::future<std::vector<Vec3>> hair;  // not valid: it is shown at rest
  };

  std::string shader_dir_;
  bool waits_;
  std::unique_ptr<render::Renderer> renderer_;  // of its own: a renderer keeps what it knows of one scene
  std::vector<std::unique_ptr<Picture>> pictures_;
  PictureSubject subject_;
  int still_ = 0;  // frames since that has changed
  std::uint64_t revision_ = 0;
  std::optional<Coming> coming_;

  Picture& pictureOf(const std::string& file);
  void begin(const std::string& file, const Demo& demo);
  void finish(const Demo& demo, int side);
};

}  // namespace app
