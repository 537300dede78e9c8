#include "options.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arrays.h"
#include "galactic/error.h"
#include "galactic/option_text.h"

namespace galactic::python {
namespace {

std::string dashed(std::string name) {
  std::ranges::replace(name, '_', '-');
  return name;
}

/// The number of axes of an array; -1 for anything else.
py::ssize_t axesOf(const py::handle& value) {
  return py::isinstance<py::array>(value) ? py::reinterpret_borrow<py::array>(value).ndim() : -1;
}

bool isList(const py::handle& value) {
  return py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value) || axesOf(value) > 0;
}

/// "an array of shape (8,)", "a list".
std::string kindOf(const py::handle& value) {
  if (axesOf(value) <= 0) return "a " + typeName(value);
  const auto array = py::reinterpret_borrow<py::array>(value);
  return fmt::format("an array of shape {}",
                     shapeText({array.shape(), static_cast<std::size_t>(array.ndim())}));
}

/// A number as text; null, without a Python error, for anything else. An object may have
/// __index__() and still fail to convert, such as a tensor.
py::object numberText(const py::handle& value) {
  auto number = py::reinterpret_steal<py::object>(
      PyIndex_Check(value.ptr()) != 0 ? PyNumber_Index(value.ptr()) : nullptr);
  PyErr_Clear();
  const bool is_real = PyNumber_Check(value.ptr()) != 0;
  if (!number && is_real) {
    number = py::reinterpret_steal<py::object>(PyNumber_Float(value.ptr()));
    PyErr_Clear();
  }
  return number ? py::object(py::str(number)) : number;
}

/// A value as the text that galactic-run reads.
std::string textOf(const std::string& keyword, const py::handle& value) {
  if (axesOf(value) == 0) {
    const py::object only = value.attr("item")();
    if (axesOf(only) != 0) return textOf(keyword, only);
  }
  if (isTruth(value)) return truthOf(keyword.c_str(), value) ? "true" : "false";
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  const py::object number = isList(value) ? py::object() : numberText(value);
  if (number) return number.cast<std::string>();
  throw py::type_error(fmt::format(
      "the option {} is {}, expected a number, a truth value or a word", keyword, kindOf(value)));
}

/// A list as text: heights are numbers or pairs of numbers, which are ranges; a pair joined by '-'
/// is a range.
std::string listText(const std::string& keyword, const py::sequence& values, char between) {
  std::string text;
  for (const auto& element : values) {
    // Keep a reference: rows of an array are created when they are accessed.
    const py::object value = element;
    if (!text.empty()) text += between;
    text +=
        isList(value) ? listText(keyword, value.cast<py::sequence>(), '-') : textOf(keyword, value);
  }
  return text;
}

/// The value of a listed option as a Python object.
py::object valueOf(const OptionText& option) {
  if (option.is_word) return py::str(option.value);
  if (option.value == "true" || option.value == "false") return py::bool_(option.value == "true");
  const py::str text(option.value);
  const bool is_whole = option.value.find_first_not_of("-0123456789") == std::string::npos;
  return is_whole ? py::object(py::int_(text)) : py::object(py::float_(text));
}

std::vector<std::string> keywordsIn(OptionScope scope) {
  std::vector<std::string> names = optionNames(scope);
  for (std::string& name : names) name = keywordOf(std::move(name));
  return names;
}

/// The names that optionsOf() takes.
std::vector<std::string> knownKeywords() {
  std::vector<std::string> known = keywordsIn(OptionScope::kTyped);
  known.insert(known.end(), {"threads", "body_transforms", "auto_reset"});
  return known;
}

[[noreturn]] void refuseValue(const char* name, const py::handle& value,
                              const std::string& wanted) {
  throw ErrorException{
      {ErrorCode::kInvalidInput, name,
       fmt::format("is {}, expected {}", py::repr(value).cast<std::string>(), wanted)}};
}

/// nullopt unless the value is a whole number from 0 to `most`.
std::optional<std::uint64_t> wholeUpTo(const py::handle& value, std::uint64_t most) {
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  const std::uint64_t found = number ? PyLong_AsUnsignedLongLong(number.ptr()) : 0;
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    return std::nullopt;
  }
  return found <= most ? std::optional(found) : std::nullopt;
}

bool mayBeDrawn(const std::string& name) {
  const std::vector<std::string> drawn = drawnOptionNames();
  return std::ranges::find(drawn, name) != drawn.end();
}

/// Sets `options` from keywords. Returns those that are in the option table.
std::vector<OptionText> setKeywords(const py::dict& keywords, SimulationOptions& options) {
  std::vector<OptionText> texts;
  for (const auto& [key, value] : keywords) {
    const auto keyword = key.cast<std::string>();
    if (value.is_none()) {
      const std::vector<std::string> known = knownKeywords();
      if (std::ranges::find(known, keyword) == known.end()) refuseKeyword(keyword, known);
    } else if (keyword == "threads") {
      options.threads = threadsOf(value);
    } else if (keyword == "body_transforms" || keyword == "auto_reset") {
      (keyword == "auto_reset" ? options.auto_reset : options.body_transforms) =
          truthOf(keyword.c_str(), value);
    } else if (keyword == "laser_heights" && isList(value)) {
      texts.push_back({dashed(keyword), listText(keyword, value.cast<py::sequence>(), ',')});
    } else if (isList(value) && py::len(value) == 2 && mayBeDrawn(dashed(keyword))) {
      texts.push_back({dashed(keyword), listText(keyword, value.cast<py::sequence>(), '-')});
    } else {
      texts.push_back({dashed(keyword), textOf(keyword, value)});
    }
  }
  const std::optional<OptionFault> fault = setOptions(texts, OptionScope::kTyped, options);
  if (!fault) return texts;
  const OptionText& text = texts[fault->index];
  if (fault->wanted.empty()) refuseKeyword(keywordOf(text.name), knownKeywords());
  throw ErrorException{{ErrorCode::kInvalidInput, keywordOf(text.name),
                        fmt::format("is {}, expected {}", text.value, fault->wanted)}};
}

}  // namespace

std::string keywordOf(std::string option) {
  std::ranges::replace(option, '-', '_');
  return option;
}

bool isTruth(const py::handle& value) {
  return py::isinstance<py::bool_>(value) ||
         py::isinstance(value, py::module_::import("numpy").attr("bool_"));
}

std::uint64_t wholeOf(const char* name, const py::handle& value, std::uint64_t least,
                      std::uint64_t most) {
  const std::optional<std::uint64_t> found = wholeUpTo(value, most);
  if (found && *found >= least) return *found;
  refuseValue(name, value, fmt::format("a whole number from {} to {}", least, most));
}

double numberOf(const char* name, const py::handle& value) {
  const bool is_number = PyNumber_Check(value.ptr()) != 0;
  const double found = is_number ? PyFloat_AsDouble(value.ptr()) : 0;
  const bool is_wrong = PyErr_Occurred() != nullptr;
  PyErr_Clear();
  if (!is_number || is_wrong) refuseValue(name, value, "a number");
  return found;
}

bool truthOf(const char* name, const py::handle& value, const char* wanted) {
  py::detail::make_caster<bool> truth;
  if (!truth.load(value, true)) refuseValue(name, value, wanted);
  return py::detail::cast_op<bool>(truth);
}

std::string wordOf(const char* name, const py::handle& value, const char* wanted) {
  if (!py::isinstance<py::str>(value)) refuseValue(name, value, wanted);
  return value.cast<std::string>();
}

std::uint32_t threadsOf(const py::handle& value) {
  const auto threads = wholeUpTo(value, kMostThreads);
  if (threads) return static_cast<std::uint32_t>(*threads);
  refuseValue("threads", value, fmt::format("0 to {}; 0 takes one per processor", kMostThreads));
}

DrawnNumber drawnOf(const char* name, const py::handle& value, const Span& within) {
  const auto number = [name](const py::handle& one) {
    return static_cast<float>(numberOf(name, one));
  };
  std::optional<DrawnNumber> found;
  if (py::isinstance<py::str>(value)) {
    found = drawnFrom(value.cast<std::string>(), within);
  } else if (isList(value) && py::len(value) == 2) {
    const auto ends = value.cast<py::sequence>();
    // Keep references: rows of an array are created when they are accessed.
    const py::object least = ends[0];
    const py::object most = ends[1];
    found = DrawnNumber(number(least), number(most));
  } else {
    found = number(value);
  }
  if (found && isDrawnWithin(*found, within)) return *found;
  refuseValue(name, value, wantedDrawn(within));
}

SimulationOptions optionsOf(const World& world, const py::dict& keywords) {
  SimulationOptions options = world.withTask();
  (void)setKeywords(keywords, options);
  return options;
}

std::vector<OptionText> taskTextsOf(const py::dict& keywords) {
  SimulationOptions options;
  const std::vector<OptionText> named = setKeywords(keywords, options);
  const std::vector<OptionText> plain = listOptions({}, OptionScope::kTask);
  const std::vector<OptionText> all = listOptions(options, OptionScope::kTask);
  std::vector<OptionText> texts;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const bool is_named = std::ranges::find(named, all[n].name, &OptionText::name) != named.end();
    if (is_named || all[n].value != plain[n].value) texts.push_back(all[n]);
  }
  return texts;
}

py::dict keywordsOf(const std::vector<OptionText>& task_texts) {
  SimulationOptions options;
  (void)setOptions(task_texts, OptionScope::kTask, options);
  const py::dict all = keywordsOf(options);
  py::dict keywords;
  for (const OptionText& text : task_texts) {
    const py::str name(keywordOf(text.name));
    keywords[name] = all[name];
  }
  return keywords;
}

py::dict keywordsOf(const SimulationOptions& options) {
  py::dict keywords;
  for (const OptionText& option : listOptions(options)) {
    keywords[keywordOf(option.name).c_str()] = valueOf(option);
  }
  return keywords;
}

std::vector<std::string> robotNoiseKeywords() { return keywordsIn(OptionScope::kRobotNoise); }

void refuseKeyword(const std::string& keyword, const std::vector<std::string>& known) {
  const py::list names = py::cast(known);
  const py::list near = py::module_::import("difflib").attr("get_close_matches")(keyword, names, 1);
  const std::string hint =
      near.empty()
          ? fmt::format("the options are {}", py::str(", ").attr("join")(names).cast<std::string>())
          : fmt::format("did you mean {}?", near[0].cast<std::string>());
  throw py::type_error(fmt::format("there is no option {}; {}", keyword, hint));
}

}  // namespace galactic::python
