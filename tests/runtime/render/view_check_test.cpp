// Views that name what is not there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "support/packs/render_model_builder.h"
#include "support/render_images.h"

namespace galactic::test::view_check_test {
namespace {

using testing::StrEq;
using testing::ThrowsMessage;

/// Three views of a library of two models: each with two instances and posed models of its own, and
/// with the list of one robot, whose links are on three bodies.
class ViewCheck : public testing::Test {
 protected:
  void SetUp() override {
    for (int n = 0; n < 2; ++n) {
      meshes_.model();
      meshes_.triangle({{{{2, 0, 0}}, {{2, 1, 0}}, {{2, 0, 1}}}}, {.two_sided = true});
    }
    meshes_.finish();
    library_.add(meshes_.meshes());
    for (std::size_t n = 0; n < views_.size(); ++n) {
      views_[n] = {.camera = {},
                   .instances = instances_[n],
                   .posed = posed_[n],
                   .attached = links_,
                   .bodies = bodies_[n]};
    }
    options_.width = options_.height = 8;
    options_.backend = RenderBackend::kSoft;
    options_.threads = 1;
  }

  /// Whichever call has the views refuses them in the same words, and goes on with others.
  void expectRefused(const std::string& message) {
    BatchRenderer renderer = makeRenderer(library_, options_);
    RenderImages images = emptyImages(options_, views_.size());
    const RenderImages untouched = images;
    const auto refuses = [&](const std::string& call) {
      return ThrowsMessage<ErrorException>(StrEq("BatchRenderer::" + call + ": " + message));
    };
    EXPECT_THAT([&] { renderer.render(views_, targetsOf(images)); }, refuses("render"));
    EXPECT_THAT([&] { renderer.beginRender(views_, targetsOf(images)); }, refuses("beginRender"));
    EXPECT_THAT([&] { static_cast<void>(renderer.renderToDevice(views_)); },
                refuses("renderToDevice"));
    EXPECT_EQ(images, untouched);
    const std::vector<RenderView> empty(views_.size());
    renderer.render(empty, targetsOf(images));
  }

  static constexpr std::size_t kViews = 3;
  RenderModelBuilder meshes_;
  RenderLibrary library_;
  RenderOptions options_;
  std::array<std::array<RenderInstance, 2>, kViews> instances_{};
  std::array<std::array<PosedModel, 2>, kViews> posed_{};
  std::array<AttachedModel, 3> links_{{{0, 2, {}}, {1, 0, {}}, {0, 1, {}}}};
  std::array<std::array<RigidTransform, 3>, kViews> bodies_{};
  std::vector<RenderView> views_{kViews};
};

TEST_F(ViewCheck, LetsEverythingPassThatIsThere) {
  const std::array<std::uint32_t, 2> ids{1000, 2000};
  instances_[2][1].model = 1;
  posed_[0][0].model = 1;
  views_[1].posed_semantics = ids;
  views_[2].attached = {};
  views_[2].bodies = {};
  BatchRenderer renderer = makeRenderer(library_, options_);
  EXPECT_NE(renderViews(renderer, views_), emptyImages(options_, kViews));
  EXPECT_EQ(renderer.statistics().instances, 3U * 4 + 2 * 3);
}

TEST_F(ViewCheck, RefusesModelsThatTheLibraryDoesNotHave) {
  const std::string wanted = ", expected one below 2 (RenderLibrary::modelCount())";
  instances_[2][1].model = 2;
  expectRefused("views[2].instances[1].model is 2" + wanted);
  instances_[2][1].model = 0;
  posed_[1][0].model = ~0U;
  expectRefused("views[1].posed[0].model is 4294967295" + wanted);
  posed_[1][0].model = 0;
  links_[1].model = 99;
  expectRefused("views[0].attached[1].model is 99" + wanted);
}

TEST_F(ViewCheck, RefusesBodiesThatAViewDoesNotHave) {
  // The list was found right with the view before.
  views_[1].bodies = views_[1].bodies.first(2);
  expectRefused("views[1].attached[0].body is 2, expected one below 2, the length of bodies");
  views_[1].bodies = bodies_[1];
  const std::array<AttachedModel, 2> others{{{0, 1, {}}, {0, ~0U, {}}}};
  views_[2].attached = others;
  expectRefused(
      "views[2].attached[1].body is 4294967295, expected one below 3, the length of bodies");
  // A part of a list that was found right is another list.
  views_[2].attached = std::span(links_).first(1);
  views_[2].bodies = {};
  expectRefused("views[2].attached[0].body is 2, expected one below 0, the length of bodies");
}

TEST_F(ViewCheck, RefusesIdsForAnotherNumberOfPosedModels) {
  const std::array<std::uint32_t, 3> ids{};
  for (const std::size_t count : {1U, 3U}) {
    views_[1].posed_semantics = std::span(ids).first(count);
    expectRefused("views[1].posed_semantics has the length " + std::to_string(count) +
                  ", expected 2, that of posed, or 0");
  }
}

}  // namespace
}  // namespace galactic::test::view_check_test
