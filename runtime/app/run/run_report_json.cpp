#include <fmt/format.h>

#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "command_line/options.h"
#include "command_line/render_options.h"
#include "drawing/frame_images.h"
#include "galactic/drawn_number.h"
#include "galactic/option_text.h"
#include "galactic/sensor_noise.h"
#include "run/run_report.h"
#include "support/option_table.h"
#include "view/json_writer.h"

namespace galactic {
namespace {

/// Writes the options of a run as they would be typed; null where the default is to type nothing.
class OptionWriter {
 public:
  explicit OptionWriter(JsonWriter& json) : json_(json) {}

  void group(std::string_view) {}
  void whole(std::string_view name, std::integral auto value, const auto&, std::string_view) {
    json_.number(name, value);
  }
  void real(std::string_view name, float value, Within<float>, std::string_view) {
    json_.number(name, value);
  }
  void wish(std::string_view name, float value, Within<float>, Shown, std::string_view) {
    value == 0 ? json_.raw(name, kNone) : json_.number(name, value);
  }
  void three(std::string_view name, const std::array<float, 3>& value, float, Shown,
             std::string_view) {
    json_.text(name, fmt::format("{}", fmt::join(value, ",")));
  }
  void point(std::string_view name, const std::optional<std::array<float, 3>>& value, float,
             Shown shown, std::string_view help) {
    value ? three(name, *value, 0, shown, help) : json_.raw(name, kNone);
  }
  void flag(std::string_view name, const Switch& value, std::string_view) {
    json_.truth(name, value.field == value.when_typed);
  }
  void text(std::string_view name, std::string_view value, Shown, std::string_view) {
    value.empty() ? json_.raw(name, kNone) : json_.text(name, value);
  }
  void word(std::string_view name, std::string_view value, std::span<const std::string_view>,
            std::string_view help) {
    text(name, value, {}, help);
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T value, const std::array<Named<T>, N>& names,
              std::string_view) {
    for (const Named<T>& one : names) {
      if (one.value == value) json_.text(name, one.name);
    }
  }
  void size(std::string_view name, const DrawingOptions& drawing, std::string_view) {
    json_.text(name, fmt::format("{}x{}", drawing.width, drawing.height));
  }
  void policy(std::string_view name, std::string_view value, std::string_view) {
    json_.text(name, value);
  }
  void likeliest(std::string_view name, bool value) { json_.truth(name, value); }
  template <class Options>
  void sensor(const SensorOption<Options>& option, const Options& options) {
    const DrawnNumber& value = options.*option.value;
    value.isRange() ? json_.text(option.name, drawnText(value))
                    : json_.number(option.name, value.least);
  }

 private:
  static constexpr const char* kNone = "null";

  JsonWriter& json_;
};

void writeOptions(JsonWriter& json, const RunReport& report) {
  RunOptions options = report.options;
  json.begin("packs", '[');
  for (const std::string& pack : options.packs) json.text("", pack);
  json.end(']');
  json.text("policy", options.policy);
  json.number("threads", report.threads);
  json.begin("options", '{');
  OptionWriter writer(json);
  visitRunOptions(options, writer);
  writeSimulation(json, options.simulation);
  json.end('}');
  json.begin("from_world", '[');
  for (const OptionText& option : report.world_task) {
    if (isInForce(option, options)) json.text("", option.name);
  }
  json.end(']');
}

void writeLearned(JsonWriter& json, const RunReport& report) {
  if (!report.learned) return;
  json.begin("learned", '{');
  json.text("name", report.learned->name);
  json.truth("samples", report.learned->samples);
  json.number("seconds", report.learned->seconds);
  json.end('}');
}

void writeTimes(JsonWriter& json, const RunReport& report) {
  const auto per_second = [&](double seconds) {
    return static_cast<double>(report.sum.steps) / seconds;
  };
  json.number("steps_per_second", per_second(report.step_seconds));
  json.number("loop_steps_per_second", per_second(report.loop_seconds));
  json.begin("seconds", '{');
  json.number("open", report.open_seconds);
  json.number("create", report.create_seconds);
  json.number("step", report.step_seconds);
  json.number("loop", report.loop_seconds);
  json.end('}');
  const double sampled = static_cast<double>(report.sampled_steps) *
                         static_cast<double>(report.options.simulation.envs);
  constexpr double kNano = 1e-9;
  json.begin("phase_ns_per_step", '{');
  for (const PhaseTime& phase : report.phases) {
    json.number(phase.name, phase.seconds / kNano / sampled);
  }
  json.end('}');
}

void writeRendering(JsonWriter& json, const RunReport& report) {
  if (!report.rendering) return;
  const RenderReport& drawn = *report.rendering;
  json.begin("rendering", '{');
  json.text("backend", drawn.backend);
  json.text("description", drawn.description);
  json.number("image_count", drawn.images);
  json.number("images_per_second", static_cast<double>(drawn.images) / report.step_seconds);
  if (!drawn.semantic_names.empty()) {
    json.begin("semantics", '[');
    for (const std::string& name : drawn.semantic_names) json.text("", name);
    json.end(']');
  }
  json.begin("seconds_per_step", '{');
  const auto mean = [&json](std::string_view key, const StepTime& time) {
    // null, because there is no mean without steps.
    json.number(key, time.seconds / static_cast<double>(time.steps));
  };
  mean("rendering_alone", drawn.rendering);
  mean("physics_alone", drawn.physics);
  mean("overlapped", drawn.overlapped);
  json.end('}');
  json.end('}');
}

void writeCounts(JsonWriter& json, const RunReport& report) {
  const SimulationStatistics& sum = report.sum;
  json.number("env_steps", sum.steps);
  json.number("refused", sum.refused);
  json.number("slid", sum.slid);
  json.number("grasps", sum.grasps);
  json.number("drops", sum.drops);
  json.number("restored", sum.restored);
  json.number("nan_actions", sum.nan_actions);
  json.number("reward", sum.reward);
  const auto ended = static_cast<double>(report.episodes.ended);
  json.begin("episodes", '{');
  json.number("ended", sum.episodes);
  json.number("successes", sum.successes);
  json.number("failures", sum.failures);
  json.number("out_of_time", sum.episodes - sum.successes - sum.failures);
  json.number("picked", sum.picks);
  // null, because there is no mean without ended episodes.
  json.number("mean_return", report.episodes.returns / ended);
  json.number("mean_steps", static_cast<double>(report.episodes.steps) / ended);
  json.number("in_world", report.world_episodes);
  json.begin("skipped", '[');
  for (const std::uint32_t episode : report.skipped) json.number("", episode);
  json.end(']');
  json.end('}');
}

}  // namespace

void writeSimulation(JsonWriter& json, const SimulationOptions& simulation) {
  for (const OptionText& option : listOptions(simulation)) {
    json.raw(option.name, option.is_word ? jsonString(option.value) : option.value);
  }
}

std::string semanticLegend(const std::vector<std::string>& names) {
  JsonWriter json;
  json.begin('{');
  json.begin("semantics", '[');
  for (std::uint32_t id = 0; id < names.size(); ++id) {
    const pictures::Rgb color = semanticColor(id);
    json.begin("", '{');
    json.number("id", id);
    json.text("name", names[id]);
    json.text("color", fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b));
    json.end('}');
  }
  json.end(']');
  json.end('}');
  return json.take();
}

std::string jsonOf(const RunReport& report) {
  JsonWriter json;
  json.begin('{');
  json.text("tool", "galactic-run");
  json.text("version", GALACTIC_VERSION);
  writeOptions(json, report);
  writeLearned(json, report);
  json.number("steps", report.steps);
  json.truth("interrupted", report.is_interrupted);
  writeTimes(json, report);
  writeRendering(json, report);
  json.number("bytes_per_env", static_cast<double>(report.memory_bytes) /
                                   static_cast<double>(report.options.simulation.envs));
  json.number("bytes_shared", static_cast<double>(report.shared_bytes));
  writeCounts(json, report);
  if (!report.options.replayFile().empty()) {
    json.raw("first_difference",
             report.first_difference ? fmt::format("{}", *report.first_difference) : "null");
  }
  json.end('}');
  return json.take();
}

}  // namespace galactic
