#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "view/page_assets.h"
#include "view/run_track.h"

namespace galactic {

struct PageOptions {
  std::string title = {};
  /// The program that writes the page, and its version.
  std::string generator = {};
  /// Longest edge of a texture on the page, texels.
  std::uint32_t texture_size = 512;
};

/// A moment of a run that a page points at.
struct PageMoment {
  std::size_t env = 0;
  /// As in EnvTrack.
  std::uint32_t frame = 0;
  std::string text = {};
};

/// A run that a page plays.
struct PageRun {
  const RunTrack* track = nullptr;
  /// What is told about it: options, counts. JSON; empty for nothing.
  std::string facts = {};
  /// One for each env; empty: the envs go by their numbers.
  std::vector<std::string> names = {};
  /// For each env the one that is shown in it as a ghost, as the same episode played elsewhere;
  /// empty: there are none.
  std::vector<std::uint32_t> twins = {};
  std::vector<PageMoment> moments = {};
};

/// One self-contained HTML file that shows packs and plays a run, if there is one: a browser opens
/// it without a network. The same packs and runs give the same bytes. Names and texts of packs
/// stand in compressed data alone, so that they cannot become markup. Fails with the errors of the
/// readers of packs.
[[nodiscard]] Result<std::string> viewPage(std::span<const PageAsset> assets, const PageRun& run,
                                           const PageOptions& options);

/// The page without data, as view/page/build.mjs writes it: in it stands kDataMark once.
[[nodiscard]] std::string_view pageTemplate();
inline constexpr std::string_view kDataMark = "<!--data-->";
inline constexpr std::string_view kTitleMark = "<title></title>";

}  // namespace galactic
