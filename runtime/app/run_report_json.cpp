#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <string_view>

#include "frame_images.h"
#include "galactic/option_text.h"
#include "run_report.h"

namespace galactic {
namespace {

/// Bytes of the UTF-8 character that `text` begins with; 0 when it begins with none.
std::size_t utf8Length(std::string_view text) {
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(text[n]); };
  constexpr std::array<std::array<unsigned, 3>, 4> kLeads{
      {{0x00, 0x7F, 1}, {0xC2, 0xDF, 2}, {0xE0, 0xEF, 3}, {0xF0, 0xF4, 4}}};
  for (const auto& [first, last, length] : kLeads) {
    if (byte(0) < first || byte(0) > last) continue;
    if (text.size() < length) return 0;
    for (std::size_t n = 1; n < length; ++n) {
      if ((byte(n) & 0xC0U) != 0x80U) return 0;
    }
    return length;
  }
  return 0;
}

/// Text as a JSON string; bytes that are no UTF-8 become question marks.
std::string jsonString(std::string_view text) {
  std::string result = "\"";
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(utf8Length(text), 1);
    const std::string_view character = text.substr(0, length);
    const auto code = static_cast<unsigned char>(text.front());
    constexpr unsigned char kFirstPrintable = 0x20;
    if (code < kFirstPrintable) {
      result += fmt::format("\\u{:04x}", code);
    } else if (text.front() == '"' || text.front() == '\\') {
      result += '\\';
      result += text.front();
    } else {
      result += utf8Length(text) == 0 ? "?" : character;
    }
    text.remove_prefix(length);
  }
  return result + '"';
}

/// Writes objects and arrays, indented, in the order of the calls.
class JsonWriter {
 public:
  void begin(char bracket) {
    text_ += bracket;
    is_first_ = true;
    ++depth_;
  }
  void begin(std::string_view key, char bracket) {
    separate(key);
    begin(bracket);
  }
  void end(char bracket) {
    --depth_;
    if (!is_first_) newLine();
    text_ += bracket;
    is_first_ = false;
  }
  void text(std::string_view key, std::string_view value) { raw(key, jsonString(value)); }
  void truth(std::string_view key, bool value) { raw(key, value ? "true" : "false"); }
  void number(std::string_view key, std::unsigned_integral auto value) {
    raw(key, fmt::format("{}", value));
  }
  void number(std::string_view key, double value) {
    raw(key, std::isfinite(value) ? fmt::format("{}", value) : "null");
  }
  void raw(std::string_view key, std::string_view value) {
    separate(key);
    text_ += value;
  }
  [[nodiscard]] std::string take() { return std::move(text_) + "\n"; }

 private:
  void newLine() {
    text_ += '\n';
    text_.append(2 * depth_, ' ');
  }
  /// `key` is empty in arrays.
  void separate(std::string_view key) {
    if (!is_first_) text_ += ',';
    is_first_ = false;
    newLine();
    if (!key.empty()) text_ += jsonString(key) + ": ";
  }

  std::string text_;
  bool is_first_ = true;
  std::size_t depth_ = 0;
};

void writeOptions(JsonWriter& json, const RunReport& report) {
  const RunOptions& options = report.options;
  json.begin("packs", '[');
  for (const std::string& pack : options.packs) json.text("", pack);
  json.end(']');
  json.text("policy", options.policy);
  json.number("threads", report.threads);
  json.begin("options", '{');
  for (const OptionText& option : listOptions(options.simulation)) {
    json.raw(option.name, option.is_word ? jsonString(option.value) : option.value);
  }
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
  const DrawingOptions& drawing = report.options.drawing;
  const RenderReport& drawn = *report.rendering;
  json.begin("rendering", '{');
  json.text("images", drawing.images);
  json.number("width", drawing.width);
  json.number("height", drawing.height);
  json.text("camera", drawing.camera);
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
    // Without a step there is no mean: null.
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
  // Without an ended episode there is no mean: null.
  json.number("mean_return", report.episodes.returns / ended);
  json.number("mean_steps", static_cast<double>(report.episodes.steps) / ended);
  json.number("in_world", report.world_episodes);
  json.begin("skipped", '[');
  for (const std::uint32_t episode : report.skipped) json.number("", episode);
  json.end(']');
  json.end('}');
}

}  // namespace

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
  writeCounts(json, report);
  if (!report.options.replayFile().empty()) {
    json.raw("first_difference",
             report.first_difference ? fmt::format("{}", *report.first_difference) : "null");
  }
  json.end('}');
  return json.take();
}

}  // namespace galactic
