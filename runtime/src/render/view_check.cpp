#include "render/view_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "support/call_check.h"

namespace galactic::render {
namespace {

class ViewCheck {
 public:
  ViewCheck(const char* call, std::span<const RenderView> views, std::size_t models)
      : call_(call), views_(views), models_(models) {}

  void check(std::size_t number) {
    const RenderView& view = views_[number];
    checkModels(number, "instances", view.instances);
    checkModels(number, "posed", view.posed);
    const std::size_t ids = view.posed_semantics.size();
    if (ids != 0 && ids != view.posed.size()) [[unlikely]] {
      detail::refuseCall(call_, fmt::format("views[{}].posed_semantics has the length {}, expected "
                                            "{}, that of posed, or 0",
                                            number, ids, view.posed.size()));
    }
    checkAttached(number, view);
  }

 private:
  template <class Placed>
  void checkModels(std::size_t number, const char* list, std::span<const Placed> placed) const {
    for (const Placed& one : placed) {
      if (one.model < models_) [[likely]] {
        continue;
      }
      detail::refuseCall(call_,
                         fmt::format("views[{}].{}[{}].model is {}, expected one below {} "
                                     "(RenderLibrary::modelCount())",
                                     number, list, &one - placed.data(), one.model, models_));
    }
  }

  void checkAttached(std::size_t number, const RenderView& view) {
    // Most views have the same list as the view before.
    if (view.attached.data() != attached_.data() || view.attached.size() != attached_.size()) {
      checkModels(number, "attached", view.attached);
      attached_ = view.attached;
      bodies_ = 0;
      for (const AttachedModel& one : attached_) {
        bodies_ = std::max(bodies_, std::size_t{one.body} + 1);
      }
    }
    if (bodies_ <= view.bodies.size()) [[likely]] {
      return;
    }
    const auto outside = std::ranges::find_if(
        view.attached, [&](const AttachedModel& one) { return one.body >= view.bodies.size(); });
    detail::refuseCall(call_, fmt::format("views[{}].attached[{}].body is {}, expected one below "
                                          "{}, the length of bodies",
                                          number, outside - view.attached.begin(), outside->body,
                                          view.bodies.size()));
  }

  const char* call_;
  std::span<const RenderView> views_;
  std::size_t models_;
  /// The list that was checked last, and how many bodies it needs.
  std::span<const AttachedModel> attached_;
  std::size_t bodies_ = 0;
};

}  // namespace

void checkViews(const char* call, std::span<const RenderView> views, std::size_t models) {
  ViewCheck check(call, views, models);
  for (std::size_t n = 0; n < views.size(); ++n) check.check(n);
}

}  // namespace galactic::render
