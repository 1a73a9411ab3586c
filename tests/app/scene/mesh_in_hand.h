// A demo whose hair mesh is changed by requests while time stands still.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "app/files/data_path.h"
#include "app/scene/demo.h"

namespace test {

using app::Ask;
using app::Demo;
using app::Request;

inline app::Scene sceneOf(app::Style style, const char* clip) {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::dataPath(std::string("assets/clips/") + clip);
  spec.style = style;
  spec.resolution = app::Resolution::kLow;
  scene.characters = {spec};
  scene.playback.settle = 0.1;
  return scene;
}

inline Demo demoOf(app::Style style = app::Style::kLong, const char* clip = "idle_turns.bvh") {
  Demo demo = app::openScene(sceneOf(style, clip), 1.5);
  for (int frame = 0; frame < 10; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  return demo;
}

inline const sim::HairMesh& meshOf(const Demo& demo) {
  return demo.actors[0].haircut->mesh;
}

// Applies a request while time stands still; returns the message when it was a fault.
inline std::string ask(const Request& request, Demo& demo) {
  demo.message.clear();
  demo.message_is_fault = false;
  demo.requests = {request, {Ask::kEndGesture, "", ""}};
  app::advanceFrame(demo, 0, {});
  return demo.message_is_fault ? demo.message : "";
}

inline void expectValid(const Demo& demo) {
  const sim::HairMesh& mesh = meshOf(demo);
  const sim::HairMesh again = sim::buildHairMesh(mesh.shape);
  EXPECT_GT(again.total_volume, 0);
  for (const sim::CornerTet& tet : again.tets) EXPECT_GT(tet.rest_volume, 0);
  const app::Actor& actor = demo.actors[0];
  EXPECT_EQ(actor.hair.positions.size(), static_cast<std::size_t>(mesh.vertexCount()));
  EXPECT_EQ(actor.previous_positions.size(), actor.hair.positions.size());
  EXPECT_EQ(actor.roots.size(), static_cast<std::size_t>(mesh.columnCount()));
  EXPECT_EQ(actor.haircut->rest.size(), 3 * actor.hair.positions.size());
}

// The columns of the top of the head, in the order in which they stand side by side, as far as edges join them.
inline std::string chainOfEdges(const Demo& demo, std::size_t edges, unsigned start) {
  const sim::HairMeshShape& shape = meshOf(demo).shape;
  std::string text;
  int here = static_cast<int>(start % static_cast<unsigned>(shape.columnCount())), before = -1;
  for (std::size_t k = 0; k < edges; ++k) {
    int next = -1;
    for (const sim::RootFace& face : shape.root_faces) {
      for (int i = 0; i < face.corner_count; ++i) {
        const int a = face.columns[static_cast<std::size_t>(i)],
                  b = face.columns[static_cast<std::size_t>((i + 1) % face.corner_count)];
        if (a == here && b != before) next = b;
      }
    }
    if (next < 0) break;
    text.append(text.empty() ? "" : " ").append(std::to_string(here)).append(" ").append(std::to_string(next));
    before = here, here = next;
  }
  return text;
}

}  // namespace test
