#include "json/figure_json.h"

#include <algorithm>
#include <utility>

#include "json/figure_fields.h"
#include "support/content_hash.h"

namespace galactic::bake {
namespace {

template <class T, class V>
concept HasFields = requires(T& value, V& visitor) {
  listFields(visitor, value);
};

/// Writes fields to a JSON object.
class FieldWriter {
 public:
  /// `rephrase` is null for the cache, which stores every detail.
  explicit FieldWriter(const Rephrase* rephrase) : rephrase_(rephrase) {}

  template <class T>
  void field(std::string_view name, T& value) {
    json_[std::string(name)] = encode(value);
  }
  template <class T>
  void field(std::string_view name, std::optional<T>& value) {
    if (value) field(name, *value);
  }
  template <class T>
  void nonzero(std::string_view name, T& value) {
    if (value != 0) field(name, value);
  }
  template <class T>
  void detail(std::string_view name, T& value) {
    when(false, name, value);
  }
  template <class T>
  void when(bool condition, std::string_view name, T& value) {
    if (condition || rephrase_ == nullptr) field(name, value);
  }
  void message(std::string_view name, const std::string& sentence) {
    json_[std::string(name)] = told(sentence);
  }
  void message(std::string_view name, const std::vector<std::string>& sentences) {
    OrderedJson list = OrderedJson::array();
    for (const std::string& sentence : sentences) list.push_back(told(sentence));
    json_[std::string(name)] = std::move(list);
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& value, const std::array<Named<T>, N>& names) {
    json_[std::string(name)] = std::ranges::find(names, value, &Named<T>::value)->name;
  }
  template <class T, std::size_t N>
  void detailChoice(std::string_view name, T& value, const std::array<Named<T>, N>& names) {
    if (rephrase_ == nullptr) choice(name, value, names);
  }
  template <class List>
  void object(std::string_view name, const List& list) {
    FieldWriter inner(rephrase_);
    list(inner);
    json_[std::string(name)] = inner.take();
  }

  [[nodiscard]] OrderedJson take() { return std::move(json_); }

 private:
  [[nodiscard]] std::string told(const std::string& sentence) const {
    return rephrase_ == nullptr ? sentence : (*rephrase_)(sentence);
  }
  template <class T>
  [[nodiscard]] OrderedJson encode(T& value) const {
    if constexpr (HasFields<T, FieldWriter>) {
      FieldWriter inner(rephrase_);
      listFields(inner, value);
      return inner.take();
    } else {
      return OrderedJson(value);
    }
  }
  template <class T>
  [[nodiscard]] OrderedJson encode(std::vector<T>& values) const {
    OrderedJson list = OrderedJson::array();
    for (T& value : values) list.push_back(encode(value));
    return list;
  }
  [[nodiscard]] OrderedJson encode(Vec3& v) const { return OrderedJson::array({v.x, v.y, v.z}); }
  /// In the order w, x, y, z.
  [[nodiscard]] OrderedJson encode(Quat& q) const {
    return OrderedJson::array({q.w, q.x, q.y, q.z});
  }
  [[nodiscard]] OrderedJson encode(LinkedPack& pack) const { return jsonOf(pack); }

  const Rephrase* rephrase_;
  OrderedJson json_ = OrderedJson::object();
};

/// Reads fields out of a JSON object. Throws what nlohmann::json throws.
class FieldReader {
 public:
  explicit FieldReader(const OrderedJson& json) : json_(json) {}

  template <class T>
  void field(std::string_view name, T& value) {
    decode(json_.at(std::string(name)), value);
  }
  template <class T>
  void field(std::string_view name, std::optional<T>& value) {
    if (json_.contains(name)) field(name, value.emplace());
  }
  template <class T>
  void nonzero(std::string_view name, T& value) {
    if (json_.contains(name)) field(name, value);
  }
  template <class T>
  void detail(std::string_view name, T& value) {
    field(name, value);
  }
  template <class T>
  void when(bool /*condition*/, std::string_view name, T& value) {
    field(name, value);
  }
  template <class T>
  void message(std::string_view name, T& sentences) {
    field(name, sentences);
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& value, const std::array<Named<T>, N>& names) {
    const auto chosen = json_.at(std::string(name)).get<std::string>();
    const auto found = std::ranges::find(names, chosen, &Named<T>::name);
    is_known_ = is_known_ && found != names.end();
    if (found != names.end()) value = found->value;
  }
  template <class T, std::size_t N>
  void detailChoice(std::string_view name, T& value, const std::array<Named<T>, N>& names) {
    choice(name, value, names);
  }
  template <class List>
  void object(std::string_view name, const List& list) {
    FieldReader inner(json_.at(std::string(name)));
    list(inner);
    is_known_ = is_known_ && inner.isKnown();
  }

  /// Whether every choice read so far had a known name.
  [[nodiscard]] bool isKnown() const { return is_known_; }

 private:
  template <class T>
  void decode(const OrderedJson& json, T& value) {
    if constexpr (HasFields<T, FieldReader>) {
      FieldReader inner(json);
      listFields(inner, value);
      is_known_ = is_known_ && inner.isKnown();
    } else {
      json.get_to(value);
    }
  }
  template <class T>
  void decode(const OrderedJson& json, std::vector<T>& values) {
    values.resize(json.size());
    for (std::size_t n = 0; n < values.size(); ++n) decode(json.at(n), values[n]);
  }
  void decode(const OrderedJson& json, Vec3& v) {
    v = {json.at(0).get<float>(), json.at(1).get<float>(), json.at(2).get<float>()};
  }
  void decode(const OrderedJson& json, Quat& q) {
    q.w = json.at(0).get<float>();
    q.x = json.at(1).get<float>();
    q.y = json.at(2).get<float>();
    q.z = json.at(3).get<float>();
  }

  const OrderedJson& json_;
  bool is_known_ = true;
};

template <class T>
OrderedJson encoded(T& figures, const Rephrase* rephrase) {
  FieldWriter writer(rephrase);
  listFields(writer, figures);
  return writer.take();
}

template <class T>
bool readAs(const OrderedJson& json, PackFigures& figures) {
  FieldReader reader(json);
  listFields(reader, figures.of.emplace<T>());
  return reader.isKnown();
}

}  // namespace

OrderedJson reportEntries(const PackFigures& figures, const Rephrase& rephrase) {
  OrderedJson entries = OrderedJson::array();
  const auto add = [&](auto& one) {
    OrderedJson fields = encoded(one, &rephrase);
    OrderedJson entry;
    if (fields.contains("input")) entry["input"] = fields["input"];
    entry["output"] = figures.output;
    entry["pack_bytes"] = figures.pack_bytes;
    entry.update(fields);
    entries.push_back(std::move(entry));
  };
  PackFigures copy = figures;
  if (auto* set = std::get_if<ObjectSetFigures>(&copy.of)) {
    for (ObjectFigures& object : set->objects) add(object);
  } else {
    std::visit(add, copy.of);
  }
  return entries;
}

OrderedJson jsonOf(const LinkedPack& pack) {
  return {{"path", pack.path},
          {"kind", packKindName(pack.kind)},
          {"bytes", pack.bytes},
          {"xxh3_128", detail::hexOf({pack.hash_low, pack.hash_high})}};
}

OrderedJson jsonOf(const PackFigures& figures) {
  PackFigures copy = figures;
  OrderedJson json{{"output", copy.output}, {"pack_bytes", copy.pack_bytes}};
  json["alternative"] = copy.of.index();
  json["of"] = std::visit([](auto& one) { return encoded(one, nullptr); }, copy.of);
  return json;
}

bool readFigures(const OrderedJson& json, PackFigures& figures) {
  json.at("output").get_to(figures.output);
  json.at("pack_bytes").get_to(figures.pack_bytes);
  const OrderedJson& of = json.at("of");
  switch (json.at("alternative").get<std::size_t>()) {
    case 0:
      return readAs<SceneFigures>(of, figures);
    case 1:
      return readAs<ObjectSetFigures>(of, figures);
    case 2:
      return readAs<RobotFigures>(of, figures);
    case 3:
      return readAs<EpisodeFigures>(of, figures);
    default:
      return false;
  }
}

}  // namespace galactic::bake
