#include "simulation/simulator/saved_state.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "galactic/option_text.h"
#include "simulation/state/plain_numbers.h"
#include "support/try.h"

namespace galactic::simulation {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::array<char, 8> kMagic{'G', 'A', 'L', 'S', 'T', 'A', 'T', 'E'};
constexpr std::uint32_t kVersion = 9;
constexpr const char* kWhere = "saved state";

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t envs = 0;
  std::uint32_t option_bytes = 0;
  /// The number of the robot's bodies; 0 if their poses were not saved.
  std::uint32_t bodies = 0;
  std::uint64_t seed = 0;
  std::uint64_t steps = 0;
  std::uint64_t world = 0;
  std::uint64_t reserved = 0;
  /// XXH3 of the header, with 0 in this field, and of all that follows.
  std::uint64_t hash = 0;
};
static_assert(sizeof(Header) == 64);

/// The numbers of an env that have a fixed size.
struct EnvRecord {
  std::uint64_t begun = 0;
  std::uint64_t turns = 0;
  std::uint64_t nan_actions = 0;
  std::uint64_t idle_steps = 0;
  double reward_sum = 0;
  /// Index into the world's episodes.
  std::uint32_t episode = 0;
  std::uint32_t step = 0;
  std::int32_t held = -1;
  /// The number of objects that the robot is leaving.
  std::uint32_t left = 0;
  std::array<std::uint32_t, 8> counts{};
  Pose grip_from_held;
  Vec3 goal;
  Vec3 target_start;
  Vec3 base;
  float yaw = 0;
  GripFrame grip{};
  float reward = 0;
  std::uint32_t ending = 0;
  std::uint16_t has_picked = 0;
  std::uint16_t was_refused = 0;
  std::uint32_t is_idle = 0;
  std::uint32_t is_named = 0;
  std::uint32_t picks = 0;
  /// has_picked of the episode that the last step ended.
  std::uint32_t had_picked = 0;
};
static_assert(std::is_trivially_copyable_v<EnvRecord> &&
              sizeof(EnvRecord) == 40 + 16 + 32 + 28 + 24 + 16 + sizeof(GripFrame) + 28);

/// The options that two simulators must share so that one can go on from a state of the other.
std::vector<OptionText> sharedOptions(const SimulationOptions& options) {
  std::vector<OptionText> shared = listOptions(options);
  std::erase_if(shared, [](const OptionText& option) {
    return option.name == "envs" || option.name == "seed" || option.name == "rank" ||
           option.name == "ranks";
  });
  return shared;
}

/// Follow the options: whether envs begin their next episodes by themselves, which is not an option
/// of programs.
constexpr std::string_view kBegins = "auto_reset=true\n";
constexpr std::string_view kWaits = "auto_reset=false\n";

std::string linesOf(const std::vector<OptionText>& options) {
  std::string lines;
  for (const OptionText& option : options) lines += option.name + "=" + option.value + "\n";
  return lines;
}

/// The hash of a whole state, for its header.
std::uint64_t hashOf(Header header, std::span<const std::byte> rest) {
  header.hash = 0;
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  XXH3_64bits_update(&state, &header, sizeof(header));
  XXH3_64bits_update(&state, rest.data(), rest.size());
  return XXH3_64bits_digest(&state);
}

/// Appends values to bytes.
class Writer {
 public:
  explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) {}

  template <class T>
  void add(const T& value) {
    add(std::span(&value, 1));
  }
  template <class T, std::size_t N>
  void add(std::span<T, N> values) {
    if (values.empty()) return;
    const std::size_t end = bytes_.size();
    bytes_.resize(end + values.size_bytes());
    std::memcpy(bytes_.data() + end, values.data(), values.size_bytes());
  }

 private:
  std::vector<std::byte>& bytes_;
};

/// Takes values from bytes. If too few are left, it becomes exhausted and leaves values unchanged.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  void take(T& value) {
    take(std::span(&value, 1));
  }
  template <class T>
  void take(std::span<T> values) {
    if (values.size_bytes() > bytes_.size()) {
      is_exhausted_ = true;
      bytes_ = {};
    } else if (!values.empty()) {
      std::memcpy(values.data(), bytes_.data(), values.size_bytes());
      bytes_ = bytes_.subspan(values.size_bytes());
    }
  }
  /// Takes `count` values; none, without allocating, if too few bytes are left.
  template <class T>
  [[nodiscard]] std::vector<T> takeMany(std::size_t count) {
    std::vector<T> values(count * sizeof(T) <= bytes_.size() ? count : 0);
    if (values.size() != count) is_exhausted_ = true;
    take(std::span<T>(values));
    return values;
  }

  [[nodiscard]] bool isExhausted() const { return is_exhausted_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
  bool is_exhausted_ = false;
};

void writeEnv(const Model& model, const BatchState& state, std::size_t n, Writer& out) {
  const Env& env = state.env(n);
  const EnvCounters& counters = state.counters(n);
  const MoveCounters& moves = state.moves(n);
  out.add(EnvRecord{
      .begun = counters.begun,
      .turns = counters.turns,
      .nan_actions = counters.nan_actions,
      .idle_steps = counters.idle_steps,
      .reward_sum = env.reward_sum,
      .episode = model.starts[env.start].episode,
      .step = env.step,
      .held = env.held,
      .left = env.left,
      .counts = {moves.refused, moves.slid, counters.grasps, counters.drops, counters.restored,
                 counters.episodes, counters.successes, counters.failures},
      .grip_from_held = state.held(n).grip_from_object,
      .goal = state.goal(n),
      .target_start = state.targetStart(n),
      .base = state.base(n),
      .yaw = state.yaw(n),
      .grip = state.grip(n),
      .reward = state.rewards()[n],
      .ending = static_cast<std::uint32_t>(state.endings()[n]),
      .has_picked = static_cast<std::uint16_t>(env.has_picked ? 1 : 0),
      .was_refused = static_cast<std::uint16_t>(env.refused ? 1 : 0),
      .is_idle = state.idle()[n],
      .is_named = counters.is_named ? 1U : 0U,
      .picks = counters.picks,
      .had_picked = state.picks()[n]});
  for (std::size_t v = 0; v < model.variableCount(); ++v) out.add(state.variable(v, n));
  for (std::size_t j = 0; j < model.motion.controlled.size(); ++j) out.add(state.lastAction(j, n));
  if (model.hasOdometry()) out.add(state.odometry(n).believed);
  for (std::size_t k = 0; k < model.keptSteps(); ++k) {
    for (const EnvRow& action : state.keptActions(n, env.step + k)) {
      out.add(action.values[n % kChunk]);
    }
  }
  out.add(state.ignored(n));
  out.add(state.leaving(n).first(env.objects * model.bodyWords()));
  out.add(state.objects(n).first(env.objects));
  out.add(state.bodyTransforms(n));
  if (state.endings()[n] != EpisodeEnd::kNone) out.add(state.finalObservation(n));
}

/// Describes what is wrong with an env's record, which may be from another world; empty if nothing
/// is.
std::string faultOfRecord(const Model& model, const EnvRecord& record) {
  if (!model.startOf(record.episode)) {
    return fmt::format("is in episode {}, which cannot be started", record.episode);
  }
  const Episode& episode = model.world->episodes().episodes()[record.episode];
  const auto objects = static_cast<std::int32_t>(model.placements(episode).size());
  if (record.held < -1 || record.held >= objects) {
    return fmt::format("holds object {} of {}", record.held, objects);
  }
  if (std::string fault = faultOfStep(model, record.step); !fault.empty()) return fault;
  if (record.ending >= kEpisodeEnds) return fmt::format("ended in way {}", record.ending);
  if (record.has_picked > 1 || record.was_refused > 1 || record.is_idle > 1 ||
      record.is_named > 1 || record.had_picked > (record.ending != 0 ? 1U : 0U) ||
      record.begun == 0 || record.turns > record.begun)
    return "has a wrong flag or count";
  const bool is_held_plain = record.held < 0 || isPlain(record.grip_from_held);
  if (!isPlain(record.goal) || !isPlain(record.target_start) || !isPlain(record.base) ||
      !isPlain(record.yaw) || !arePlain(record.grip) || !isPlain(record.reward) ||
      !std::isfinite(record.reward_sum) || !is_held_plain) {
    return "has a number that no simulation leaves";
  }
  return {};
}

SavedEnv envOf(const Model& model, const EnvRecord& record) {
  const auto& [refused, slid, grasps, drops, restored, episodes, successes, failures] =
      record.counts;
  SavedEnv saved;
  // faultOfRecord() has checked that there is one.
  saved.env.start = *model.startOf(record.episode);
  saved.env.step = record.step;
  saved.env.held = record.held;
  saved.held.grip_from_object = record.grip_from_held;
  saved.env.has_picked = record.has_picked != 0;
  saved.env.refused = record.was_refused != 0;
  saved.env.left = record.left;
  saved.env.objects =
      static_cast<std::uint32_t>(model.placements(model.episodeOf(saved.env.start)).size());
  saved.is_idle = record.is_idle != 0;
  saved.env.reward_sum = record.reward_sum;
  saved.counters = {.begun = record.begun,
                    .turns = record.turns,
                    .grasps = grasps,
                    .drops = drops,
                    .restored = restored,
                    .episodes = episodes,
                    .successes = successes,
                    .failures = failures,
                    .nan_actions = record.nan_actions,
                    .idle_steps = record.idle_steps,
                    .picks = record.picks,
                    .is_named = record.is_named != 0};
  saved.moves = {.refused = refused, .slid = slid};
  saved.goal = record.goal;
  saved.target_start = record.target_start;
  saved.base = record.base;
  saved.yaw = record.yaw;
  saved.grip = record.grip;
  saved.reward = record.reward;
  saved.ending = static_cast<EpisodeEnd>(record.ending);
  saved.had_picked = record.had_picked != 0;
  return saved;
}

/// Whether the robot is leaving as many objects as the record says, and not the one in its hand.
bool leavesAsSaid(const Model& model, const SavedEnv& saved) {
  const std::size_t words = model.bodyWords();
  std::uint32_t left = 0;
  for (std::uint32_t object = 0; object < saved.env.objects; ++object) {
    const auto row = std::span(saved.leaving).subspan(object * words, words);
    if (isEmpty(row)) continue;
    if (static_cast<std::int32_t>(object) == saved.env.held) return false;
    ++left;
  }
  return left == saved.env.left;
}

/// Whether these can be actions of steps: from -1 to 1; those of hand and terminate may be NaN,
/// from steps before the first action.
bool areActions(std::span<const float> actions, const ActionLayout& layout) {
  for (std::size_t n = 0; n < actions.size(); ++n) {
    const bool may_be_none = n % layout.count() >= layout.movingCount() && std::isnan(actions[n]);
    if (!may_be_none && !(std::abs(actions[n]) <= 1)) return false;
  }
  return true;
}

tl::unexpected<Error> refused(std::string message) {
  return fail(ErrorCode::kInvalidInput, kWhere, std::move(message));
}

/// Reads env number `n` of the state.
Result<SavedEnv> readEnv(const Model& model, const Header& header, std::size_t n, Reader& in) {
  EnvRecord record;
  in.take(record);
  if (in.isExhausted()) return refused("ends before its last env; it is damaged");
  const std::string fault = faultOfRecord(model, record);
  if (!fault.empty()) return refused(fmt::format("env {} {}; it is damaged", n, fault));
  SavedEnv saved = envOf(model, record);
  saved.variables = in.takeMany<float>(model.variableCount());
  saved.last_actions = in.takeMany<float>(model.motion.controlled.size());
  if (model.hasOdometry()) in.take(saved.believed);
  saved.kept_actions = in.takeMany<float>(model.keptSteps() * model.actionCount());
  saved.ignored = in.takeMany<std::uint64_t>(model.heldWords());
  saved.leaving = in.takeMany<std::uint64_t>(saved.env.objects * model.bodyWords());
  saved.objects = in.takeMany<Pose>(saved.env.objects);
  saved.bodies = in.takeMany<RigidTransform>(header.bodies);
  if (saved.ending != EpisodeEnd::kNone) {
    saved.final_observation = in.takeMany<float>(model.observation_size);
  }
  if (in.isExhausted()) return refused("ends before its last env; it is damaged");
  if (!leavesAsSaid(model, saved)) {
    return refused(fmt::format("env {} leaves other objects than it says; it is damaged", n));
  }
  const auto plain = [](const auto& one) { return isPlain(one); };
  const PlanarPose& believed = saved.believed;
  if (!arePlain(saved.variables) || !arePlain(saved.last_actions) ||
      !areActions(saved.kept_actions, model.actionLayout()) || !isPlain(believed.x) ||
      !isPlain(believed.z) || !isPlain(believed.yaw) ||
      !std::ranges::all_of(saved.objects, plain) || !std::ranges::all_of(saved.bodies, plain)) {
    return refused(fmt::format("env {} has a number that no simulation leaves; it is damaged", n));
  }
  return saved;
}

/// Checks the world and the options of a state, but not its envs.
Result<void> checkSubject(const Model& model, const Header& header, std::string_view lines) {
  if (header.world != model.world->hash()) {
    return refused("is of another world; restore it where it was saved");
  }
  const std::vector<OptionText> options = sharedOptions(model.options);
  const std::vector<OptionText> defaults = sharedOptions({});
  for (std::size_t n = 0; n < options.size(); ++n) {
    const OptionText& option = options[n];
    const std::string line = option.name + "=" + option.value + "\n";
    if (lines.starts_with(line)) {
      lines.remove_prefix(line.size());
      continue;
    }
    // A version that did not have this option yet behaved as its default.
    const bool is_named = lines.starts_with(option.name + "=");
    if (is_named) {
      return refused(fmt::format("was saved with other options: expected {}={}, found {}",
                                 option.name, option.value, lines.substr(0, lines.find('\n'))));
    }
    if (option.value == defaults[n].value) continue;
    return refused(fmt::format(
        "was saved where there was no option {}: restore it where that is {}, as by default, "
        "instead of {}",
        option.name, defaults[n].value, option.value));
  }
  if (lines.empty() || lines == kBegins || lines == kWaits) return {};
  return refused("was saved with options that this version does not know");
}

/// Whether an env waits for a caller to begin its next episode, which no caller does with
/// auto_reset.
bool waitsInVain(const Model& model, const SavedEnv& saved, std::string_view lines) {
  return model.options.auto_reset && saved.is_idle && lines.ends_with(kWaits);
}

}  // namespace

std::vector<std::byte> saveEnvs(const Model& model, const BatchState& state,
                                std::span<const std::uint32_t> envs, std::uint64_t steps) {
  std::string lines = linesOf(sharedOptions(model.options));
  lines += model.options.auto_reset ? kBegins : kWaits;
  Header header{.envs = static_cast<std::uint32_t>(envs.size()),
                .option_bytes = static_cast<std::uint32_t>(lines.size()),
                .bodies = static_cast<std::uint32_t>(model.bodyCount()),
                .seed = model.options.seed,
                .steps = steps,
                .world = model.world->hash()};
  std::vector<std::byte> bytes;
  Writer out(bytes);
  out.add(header);
  out.add(std::span(lines));
  for (const std::uint32_t env : envs) writeEnv(model, state, env, out);
  header.hash = hashOf(header, std::span(bytes).subspan(sizeof(header)));
  std::memcpy(bytes.data(), &header, sizeof(header));
  return bytes;
}

std::string faultOfStep(const Model& model, std::uint32_t step) {
  const std::uint32_t most_steps = model.options.task.most_steps;
  if (most_steps == 0 || step <= most_steps) return {};
  return fmt::format("is after {} steps, and an episode has {}", step, most_steps);
}

Result<SavedState> readState(const Model& model, std::span<const std::byte> bytes) {
  Header header;
  Reader in(bytes);
  in.take(header);
  if (in.isExhausted() || header.magic != kMagic) {
    return refused("is none; give what saving a state returned");
  }
  if (header.version != kVersion) {
    return fail(ErrorCode::kUnsupported, kWhere,
                fmt::format("has format version {}, expected {}; use the version that saved it",
                            header.version, kVersion));
  }
  if (header.hash != hashOf(header, bytes.subspan(sizeof(header)))) {
    return refused("does not have the hash that it states; it is damaged");
  }
  const std::vector<char> text = in.takeMany<char>(header.option_bytes);
  const std::string_view lines(text.data(), text.size());
  RETURN_IF_ERROR(checkSubject(model, header, lines));
  const std::size_t bodies = model.motion.nodes.size() + 1;
  if (header.bodies != 0 && header.bodies != bodies) {
    return refused(fmt::format("has {} bodies, expected {}; it is damaged", header.bodies, bodies));
  }
  SavedState saved{.seed = header.seed, .steps = header.steps, .envs = {}};
  for (std::uint32_t n = 0; n < header.envs; ++n) {
    ASSIGN_OR_RETURN(SavedEnv env, readEnv(model, header, n, in));
    if (waitsInVain(model, env, lines)) {
      return refused(
          fmt::format("env {} waits where its episode ended, which envs with auto_reset "
                      "do not; begin its next episode before you save it",
                      n));
    }
    saved.envs.push_back(std::move(env));
  }
  if (in.left() != 0) return refused("goes on behind its last env; it is damaged");
  return saved;
}

}  // namespace galactic::simulation
