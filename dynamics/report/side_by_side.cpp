#include "dynamics/report/side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "drawing/contact_sheet.h"
#include "drawing/frame_images.h"
#include "dynamics/report/best_view.h"
#include "dynamics/report/names.h"
#include "pictures/png_file.h"
#include "run/tracked_run.h"
#include "support/files/atomic_file.h"
#include "support/try.h"
#include "view/json_writer.h"
#include "view/page.h"
#include "view/run_track.h"

namespace galactic::dynamics {
namespace {

/// The number of episodes on a page without moments.
constexpr std::size_t kWithoutMoments = 4;

/// Records one world while an episode is played in it.
class RunRecorder {
 public:
  /// `best`: takes a still of each frame; null without pictures.
  RunRecorder(const World& world, BestView* best) : world_(world), best_(best) {}

  void record(const BatchSimulator& simulator, std::span<const float> actions) {
    if (actions.empty()) {
      track_.emplace(world_, simulator, 1);
    } else {
      track_->add(simulator, actions);
    }
    if (best_ != nullptr) stills_.push_back(best_->take(simulator));
  }

  [[nodiscard]] const RunTrack& track() const { return *track_; }
  [[nodiscard]] const Still& still(std::uint32_t frame) const { return stills_[frame]; }

 private:
  const World& world_;
  BestView* best_;
  std::optional<RunTrack> track_;
  /// By frame.
  std::vector<Still> stills_;
};

/// Makes a lane repeat what the simulation did.
void replaySimulation(const EpisodeTrace& trace, EpisodeLane& lane, RunRecorder& recorder) {
  lane.begin(trace.episode, ArmDrive::kKinematic);
  recorder.record(lane.simulator(), {});
  for (std::size_t n = 0; n < trace.steps.size(); ++n) {
    const TracedStep& step = trace.steps[n];
    const std::vector<Pose> objects = objectsAfter(trace, n);
    lane.follow(step.actions, {.world_from_root = step.world_from_root,
                               .joint_positions = step.positions,
                               .objects = objects,
                               .held = step.held ? static_cast<std::int32_t>(*step.held) : -1,
                               .was_hindered = step.was_refused});
    recorder.record(lane.simulator(), step.actions);
  }
}

/// What a picture of a moment must show.
PictureSubject subjectOf(const Moment& moment, const EpisodeComparison& episode,
                         const EpisodeTrace& trace, const Robot& robot) {
  switch (moment.kind) {
    case MomentKind::kLost:
      return {.objects = {trace.target}};
    case MomentKind::kMissed:
      return {.link = std::get<0>(episode.deepest->key)};
    case MomentKind::kApart: {
      PictureSubject hand{.link = robot.endEffector()->link};
      if (const auto held = trace.steps[moment.step].held) hand.objects = {*held};
      return hand;
    }
    case MomentKind::kMoved:
      break;
  }
  const auto release = std::ranges::find(trace.releases, moment.step, &TracedRelease::step);
  return {.objects = {release->object}};
}

std::string factsOf(const ReportSubject& subject) {
  JsonWriter json;
  json.begin('{');
  const bool is_replay = subject.mode == ComparisonMode::kReplay;
  json.text("policy", is_replay ? "replay" : subject.played);
  if (is_replay) json.text("recording", subject.played);
  json.text("arm", nameOf(subject.world.arm));
  json.text("base", nameOf(subject.world.base));
  json.end('}');
  return json.take();
}

/// Plays the episodes of the worst moments again, or the first episodes if there are no such
/// moments.
class SideBySide {
 public:
  SideBySide(const SideBySideParts& parts, const SideBySideFiles& files)
      : parts_(parts), files_(files) {}

  Result<void> play() {
    ASSIGN_OR_RETURN(simulated_lane_, parts_.episodes.makeLane());
    ASSIGN_OR_RETURN(dynamic_lane_, parts_.episodes.makeLane());
    if (!files_.pictures.empty()) {
      ASSIGN_OR_RETURN(best_, BestView::create(parts_.worlds.world, simulated_lane_->simulator()));
    }
    std::map<std::size_t, std::vector<std::size_t>> moments;
    for (std::size_t n = 0; n < worst().size(); ++n) moments[worst()[n].comparison].push_back(n);
    if (moments.empty()) {
      const std::size_t all = parts_.comparisons.episodes.size();
      for (std::size_t n = 0; n < std::min(all, kWithoutMoments); ++n) moments[n] = {};
    }
    cells_.resize(2 * worst().size());
    for (const auto& [comparison, of] : moments) RETURN_IF_ERROR(play(comparison, of));
    return {};
  }

  [[nodiscard]] Result<void> writePictures() const {
    std::vector<SheetCell> cells;
    for (const std::optional<SheetCell>& cell : cells_) cells.push_back(*cell);
    constexpr std::size_t kColumns = 2;
    return pictures::writePng(files_.pictures, contactSheet(cells, kColumns));
  }

  [[nodiscard]] Result<void> writePage() const {
    ASSIGN_OR_RETURN(const auto assets, pageAssetsOf(*track_));
    ASSIGN_OR_RETURN(const auto page, viewPage(assets,
                                               {.track = &*track_,
                                                .facts = factsOf(parts_.subject),
                                                .names = names_,
                                                .twins = twins_,
                                                .moments = page_moments_},
                                               {.title = files_.view.stem().string(),
                                                .generator = "galactic-dynamics"}));
    return writeFileAtomically(files_.view, page);
  }

 private:
  [[nodiscard]] const std::vector<Moment>& worst() const { return parts_.comparisons.worst; }

  Result<void> play(std::size_t comparison, const std::vector<std::size_t>& moments) {
    const World& world = parts_.worlds.world;
    BestView* const best = moments.empty() ? nullptr : best_.get();
    RunRecorder simulated(world, best);
    RunRecorder dynamic(world, best);
    ASSIGN_OR_RETURN(const auto trace, parts_.episodes.trace(comparison, *simulated_lane_));
    replaySimulation(trace, *simulated_lane_, simulated);
    RETURN_IF_ERROR(compareEpisode(
        trace, *dynamic_lane_, parts_.worlds, parts_.episodes.actions(trace, *dynamic_lane_),
        [&](const BatchSimulator& simulator, std::span<const float> actions) {
          dynamic.record(simulator, actions);
        }));
    keep(simulated.track(), dynamic.track(), trace.episode);
    for (const std::size_t n : moments) {
      keep(n, simulated.track(), dynamic.track());
      if (best != nullptr) draw(n, trace, simulated, dynamic);
    }
    return {};
  }

  void keep(const RunTrack& simulated, const RunTrack& dynamic, std::uint32_t episode) {
    if (track_) {
      track_->append(simulated);
    } else {
      track_.emplace(simulated);
    }
    track_->append(dynamic);
    const auto first = static_cast<std::uint32_t>(names_.size());
    names_.push_back(fmt::format("Episode {}: simulation", episode));
    names_.push_back(fmt::format("Episode {}: dynamics", episode));
    twins_.insert(twins_.end(), {first + 1, first});
  }

  /// Adds a moment of the page's last two envs.
  void keep(std::size_t n, const RunTrack& simulated, const RunTrack& dynamic) {
    const Moment& moment = worst()[n];
    const EpisodeComparison& episode = parts_.comparisons.episodes[moment.comparison];
    const MomentPlace place = placeOf(moment, simulated.steps(), dynamic.steps());
    page_moments_.push_back({.env = names_.size() - (place.is_simulation ? 2 : 1),
                             .frame = place.frame,
                             .text = describe(moment, episode, parts_.worlds.world)});
  }

  void draw(std::size_t n, const EpisodeTrace& trace, const RunRecorder& simulated,
            const RunRecorder& dynamic) {
    const Moment& moment = worst()[n];
    const EpisodeComparison& episode = parts_.comparisons.episodes[moment.comparison];
    const PictureSubject subject = subjectOf(moment, episode, trace, parts_.worlds.world.robot());
    const MomentSides sides =
        sidesOf(moment, episode, {simulated.track(), dynamic.track()}, parts_.subject.mode);
    const std::array stills{simulated.still(sides.simulated.frame),
                            sides.rest
                                ? BestView::withoutRobot(simulated.still(sides.simulated.frame),
                                                         subject.objects.front(), *sides.rest)
                                : dynamic.still(sides.dynamic.frame)};
    const auto cameras = best_->camerasFor({&stills[0], &stills[1]}, subject);
    const std::array captions{
        fmt::format("{}. episode {}, {}", n + 1, episode.episode, sides.simulated.said),
        sides.dynamic.said};
    for (std::size_t side = 0; side < stills.size(); ++side) {
      cells_[2 * n + side] = {colorPicture(best_->draw(stills[side], cameras[side])),
                              captions[side]};
    }
  }

  const SideBySideParts& parts_;
  const SideBySideFiles& files_;
  /// Lanes that follow the two worlds.
  std::unique_ptr<EpisodeLane> simulated_lane_;
  std::unique_ptr<EpisodeLane> dynamic_lane_;
  /// Null without pictures.
  std::unique_ptr<BestView> best_;
  std::optional<RunTrack> track_;
  std::vector<std::string> names_;
  std::vector<std::uint32_t> twins_;
  std::vector<PageMoment> page_moments_;
  /// Two for each moment.
  std::vector<std::optional<SheetCell>> cells_;
};

}  // namespace

Result<std::vector<std::string>> writeSideBySide(const SideBySideParts& parts,
                                                 const SideBySideFiles& files) {
  SideBySideFiles possible = files;
  std::vector<std::string> notes;
  if (!files.pictures.empty() && parts.comparisons.worst.empty()) {
    possible.pictures.clear();
    notes.push_back(fmt::format(
        "{} is not written: there is no moment to draw, as in no episode a success is lost, a "
        "contact missed, or anything more than {:.0f} cm from where the simulation has it",
        files.pictures.string(), static_cast<double>(kDisturbed) * 100));
  }
  if (possible.view.empty() && possible.pictures.empty()) return notes;
  SideBySide both(parts, possible);
  RETURN_IF_ERROR(both.play());
  if (!possible.pictures.empty()) RETURN_IF_ERROR(both.writePictures());
  if (!possible.view.empty()) RETURN_IF_ERROR(both.writePage());
  return notes;
}

}  // namespace galactic::dynamics
