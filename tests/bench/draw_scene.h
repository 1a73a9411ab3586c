// Scenes whose drawing is measured: a moment of each, and the moment a frame later, drawn with any setting.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/scene/demo.h"
#include "tests/bench/draw_picture.h"
#include "tests/bench/draw_setting.h"

namespace bench {

struct DrawScene {
  const char* name;
  const char* file;     // of assets/scenes
  const char* framing;  // of the camera; empty: the scene's
  double nearer;        // times the distance that the camera would have
  int width, height;    // pixels
  int frames;           // of 1/60 s until the moment that is drawn
};

// close_up, bust, figure, ten and hundred.
std::vector<DrawScene> drawScenes();

// What the demo shows, without what sampling, level of detail and maps leave out: the same strands in a larger picture,
// four pixels and more for every one, twice the detail for each of those. `larger`, if given, gets it.
LevelPicture referencePicture(app::Demo& demo, int width, int height, render::Renderer& renderer,
                              LevelPicture* larger = nullptr);

// The truth that a scene's pictures are compared with.
struct DrawReference {
  LevelPicture picture;
  PictureError own;  // of its mean, by two halves
};

// What a whole frame took, of which everything has moved since the one before.
struct DrawnFrame {
  double wall = 0, processor = 0;  // s; processor: of all threads
  long strands = 0;
  LevelPicture picture;
};

class DrawStage {
 public:
  // Needs a current context. Throws app::InputError.
  DrawStage(const DrawScene& scene, render::Renderer& renderer);

  const DrawScene& scene() const { return scene_; }
  // Draws the moment and then the frame after it, which is measured.
  DrawnFrame draw(const DrawSetting& setting);
  // See referencePicture.
  DrawReference reference();
  // Moment 0 or 1 as a setting draws it, in a picture of any size. What it points to lives until the next call.
  render::FrameInput frame(const DrawSetting& setting, int moment, int width, int height);

 private:
  // What a frame hands over of one character.
  struct Shown {
    std::vector<float> positions;
    app::ShownSkin skin;
    std::vector<render::Mat4> joints;
    std::vector<render::Mat4> worn;
  };
  std::vector<Shown> shownNow() const;
  void show(const std::vector<Shown>& moment);

  DrawScene scene_;
  render::Renderer& renderer_;
  app::Demo demo_;
  std::vector<Shown> moments_[2];
};

}  // namespace bench
