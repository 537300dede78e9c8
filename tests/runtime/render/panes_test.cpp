// How images are cut into panes.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "render/render_engine.h"

namespace galactic::test::panes_test {
namespace {

using render::kPaneEdge;
using render::kTileEdge;
using render::PaneRectangle;

constexpr std::array<std::uint32_t, 10> kEdges{1, 7, 8, 9, 255, 256, 257, 513, 640, 1024};

TEST(Panes, CoverEachPixelOfAnImageOnce) {
  for (const std::uint32_t width : kEdges) {
    for (const std::uint32_t height : kEdges) {
      std::vector<std::uint8_t> covered(width * height);
      for (const PaneRectangle& pane : render::cutIntoPanes(width, height)) {
        ASSERT_LE(pane.left + pane.width, width);
        ASSERT_LE(pane.top + pane.height, height);
        for (std::uint32_t y = pane.top; y < pane.top + pane.height; ++y) {
          for (std::uint32_t x = pane.left; x < pane.left + pane.width; ++x) {
            ++covered[y * width + x];
          }
        }
      }
      ASSERT_EQ(covered, std::vector<std::uint8_t>(width * height, 1)) << width << " x " << height;
    }
  }
}

TEST(Panes, AreFewAndBeginAtTiles) {
  for (const std::uint32_t edge : kEdges) {
    EXPECT_LE(render::paneEdge(edge), kPaneEdge) << edge;
    EXPECT_EQ(render::paneEdge(edge) % kTileEdge, 0) << edge;
    EXPECT_EQ(render::cutIntoPanes(edge, 1).size(), (edge + kPaneEdge - 1) / kPaneEdge) << edge;
    for (const PaneRectangle& pane : render::cutIntoPanes(edge, edge)) {
      EXPECT_EQ(pane.left % render::paneEdge(edge), 0) << edge;
      EXPECT_EQ(pane.top % render::paneEdge(edge), 0) << edge;
    }
  }
}

}  // namespace
}  // namespace galactic::test::panes_test
