#include "scene/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <random>
#include <set>

#include "scene/reading.hpp"

namespace strata {
namespace {

constexpr double most_runs = 10000;  // each run's scene is read, in a tenth of a millisecond

// A key that runs differ in: its values or, where they are sampled, a range by the share of it that a value is at.
struct Swept {
  std::string key;
  Where where;
  std::vector<Setting> list;  // of its values alone
  std::function<double(double)> range;

  Setting sampled(double share) const {
    if (range) return {number_text(range(share)), where};
    const auto size = static_cast<double>(list.size());
    return list[static_cast<std::size_t>(std::min(share * size, size - 1.0))];
  }
};

using Axis = std::vector<Swept>;  // keys that move together
using Numbers = std::map<std::string_view, double>;

// What the tables of a range and of a sample hold. Of words the number counts.
Key entry(Key::Kind kind, std::string_view name, Bounds bounds, std::string_view words = "", bool required = true) {
  return {kind, name, {}, "", "", bounds, words, "", "", required};
}
const Key count = entry(Key::Kind::integer, "count", {2.0, most_runs, false, false});

// A value as part of a folder's name: 3e6 as 3000000, "weak" as weak, a list as its number.
std::string name_of(std::string text, std::size_t number) {
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  if (text.find_first_of("\"'") == 0) text = text.substr(1, text.size() - 2);
  return is_plain_name(text, ".+") && text[0] != '.' ? text : std::to_string(number + 1);
}

class SweepReader {
 public:
  SweepReader(Reading& reading, const Where& source, const std::vector<std::string>& variants)
      : reading_(reading), values_(reading), source_(source), variants_(variants) {
    values_.faults.clear();
  }

  std::vector<SweepRun> read(const toml::node& sweep) {
    const std::size_t before = reading_.faults.size();
    const toml::table* table = sweep.as_table();
    if (table == nullptr || table->empty()) {
      reading_.fault(at(sweep), "sweep is not a table of keys. Write [sweep] and below it KEY = [values].");
    } else {
      if (const toml::node* sample = table->get("sample")) take_sample(*sample);
      for (const Swept& one : axis_of(*table, "", true)) axes_.push_back({one});
      if (const toml::node* together = table->get("together")) take_together(*together);
    }
    reading_.faults.insert(reading_.faults.end(), values_.faults.begin(), values_.faults.end());
    reading_.used.merge(values_.used);
    if (reading_.faults.size() > before) return {};
    std::ranges::sort(axes_, {}, [](const Axis& a) { return std::pair(a[0].where.line, a[0].where.column); });
    double runs = sample_ ? sample_->at("count") : 1.0;
    for (const Axis& axis : axes_) runs *= sample_ ? 1.0 : static_cast<double>(axis[0].list.size());
    if (runs <= most_runs) return sample_ ? sampled() : product(static_cast<std::size_t>(runs));
    reading_.fault(at(sweep), "sweep makes {} runs, at most {} can be. Give fewer values, or sample them.", runs,
                   most_runs);
    return {};
  }

 private:
  // Where something stands; like --set it lies above scene and variant.
  Where at(const auto& node) const {
    const Where where = where_of(source_, node.source());
    return {where.source, 2, where.line, where.column};
  }

  // The keys of a table and of those in it, in the order of the file.
  Axis axis_of(const toml::table& table, const std::string& prefix, bool is_sweep) {
    Axis axis;
    for (const auto& [name, value] : table) {
      const std::string path = prefix.empty() ? std::string(name.str()) : fmt::format("{}.{}", prefix, name.str());
      const bool is_own = path == "sample" || path == "together",
                 is_key = path == "variant" || find_key(path) != nullptr;
      const std::string meant = prefix.empty() ? did_you_mean(path, {"together", "sample", "variant"}) : "";
      if (is_sweep && is_own) continue;
      if (!is_key && names_in_table(path).empty()) {
        if (!meant.empty()) reading_.fault(at(name), "unknown key sweep.{}.{}", path, meant);
        if (meant.empty()) take_value(values_, path, value, at(name));  // which says what is wrong
      } else if (!is_key && value.is_table()) {
        for (const Swept& one : axis_of(*value.as_table(), path, is_sweep)) axis.push_back(one);
      } else if (const std::string quoted = quoted_element(path, value); !quoted.empty()) {
        reading_.fault(at(name), "sweep.{} is a list. Name an element of it, counted from 0, in quotes: {} = [values].",
                       path, quoted);
      } else {
        if (!paths_.insert(path).second) reading_.fault(at(name), "sweep has {} twice. Remove one.", path);
        take_values(axis.emplace_back(Swept{path, at(name), {}, {}}), value);
      }
    }
    std::ranges::sort(axis, {}, [](const Swept& s) { return std::pair(s.where.line, s.where.column); });
    return axis;
  }

  void take_values(Swept& one, const toml::node& values) {
    const toml::array* list = values.as_array();
    if (values.is_table()) {
      take_range(one, *values.as_table());
    } else if (list == nullptr || list->empty()) {
      reading_.fault(at(values),
                     "sweep.{} = {} is neither a list of values nor a range {{from, to, count}}. What is the same in "
                     "all runs stands outside [sweep].",
                     one.key, as_typed(values));
    } else {
      for (const toml::node& value : *list) {
        one.list.push_back({as_one_line(value), at(value)});
        try_value(one.key, value, at(value));
      }
    }
    std::set<std::string> names;
    for (const auto& [value, where] : one.list) {
      if (!names.insert(name_of(value, names.size())).second)
        reading_.fault(where, "sweep.{} has {} twice. Remove one. Those of a range have six digits.", one.key,
                       shortened(value, 60));
    }
  }

  // One value by itself, by the rules of its key.
  void try_value(const std::string& key, const toml::node& value, const Where& where) {
    if (key != "variant") return take_value(values_, key, value, where);
    const std::string name = value.value_or(std::string());
    if (std::ranges::find(variants_, name) == variants_.end())
      reading_.fault(where, "sweep.variant = {} is no variant. There is {}.{}", as_typed(value),
                     variants_.empty() ? "none" : fmt::format("{}", fmt::join(variants_, ", ")),
                     did_you_mean(name, variants_));
  }

  // The entries of a range or a sample; nothing where one is missing or of no use.
  std::optional<Numbers> numbers_of(const toml::table& table, const std::string& of, const std::vector<Key>& keys) {
    const std::size_t before = reading_.faults.size();
    Numbers numbers;
    std::vector<std::string> names;
    for (const Key& key : keys) {
      names.emplace_back(key.path);
      const toml::node* node = table.get(key.path);
      if (node == nullptr && key.required) reading_.fault(at(table), "{}.{} is missing.", of, key.path);
      if (node == nullptr) continue;
      const Value value{fmt::format("{}.{}", of, key.path), key, *node, at(*node), reading_.faults};
      int word = 0;
      if (key.kind != Key::Kind::word) strata::read(value, numbers[key.path]);
      if (key.kind == Key::Kind::word && read_word(value, key.allowed, word)) numbers[key.path] = word;
    }
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::ranges::find(names, name) == names.end())
        reading_.fault(at(node), "unknown key {}.{}. It has {}.{}", of, name, fmt::format("{}", fmt::join(names, ", ")),
                       did_you_mean(name, names));
    }
    return reading_.faults.size() > before ? std::nullopt : std::optional(numbers);
  }

  void take_range(Swept& one, const toml::table& table) {
    const bool is_log = table["scale"].value_or(std::string()) == "log";
    const Bounds above = is_log ? Bounds{0.0} : Bounds();
    std::vector<Key> keys{entry(Key::Kind::number, "from", above), entry(Key::Kind::number, "to", above),
                          entry(Key::Kind::word, "scale", {}, "linear, log", false)};
    if (!sample_) keys.push_back(count);
    auto numbers = numbers_of(table, "sweep." + one.key, keys);
    if (!numbers) return;
    const double from = numbers->at("from"), to = numbers->at("to"), last = (*numbers)["count"] - 1.0;
    // Rounded to six digits, so that no machine's power function shows; the ends are as they were given.
    one.range = [=](double share) {
      if (share <= 0.0 || share >= 1.0) return share <= 0.0 ? from : to;
      const double value = is_log ? from * std::pow(to / from, share) : from + share * (to - from);
      return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
    };
    for (double k = 0.0; k <= last; ++k) one.list.push_back({number_text(one.range(k / last)), one.where});
    for (const double end : {from, to}) try_value(one.key, toml::value<double>(end), at(table));
    if (from == to) reading_.fault(at(table), "sweep.{}: from and to are the same.", one.key);
  }

  void take_sample(const toml::node& node) {
    sample_ = Numbers();
    if (!node.is_table())
      return reading_.fault(at(node), "sweep.sample = {} is not a table. Write {{method, count, seed}}.",
                            as_typed(node));
    sample_ = numbers_of(*node.as_table(), "sweep.sample",
                         {entry(Key::Kind::word, "method", {}, "latin_hypercube"), count,
                          entry(Key::Kind::integer, "seed", {0.0, 0x1p53, false, false})})
                  .value_or(Numbers());
  }

  void take_together(const toml::node& node) {
    if (!node.is_array_of_tables())
      return reading_.fault(at(node), "sweep.together is not a list of tables. Write [[sweep.together]] above keys.");
    for (const toml::node& table : *node.as_array()) {
      const Axis axis = axis_of(*table.as_table(), "", false);
      for (const Swept& one : axis) {
        if (!sample_ && one.list.size() != axis[0].list.size())
          reading_.fault(one.where, "sweep.{} has {} values, and {}, with which it goes together, {}.", one.key,
                         one.list.size(), axis[0].key, axis[0].list.size());
      }
      if (!axis.empty()) axes_.push_back(axis);
    }
  }

  static void give(SweepRun& run, const std::string& key, const Setting& value) {
    if (key != "variant") return run.set.push_back({key + '=' + value.text, value.where});
    run.variant = value.text.substr(1, value.text.size() - 2);
  }

  std::vector<SweepRun> product(std::size_t count) const {
    std::vector<SweepRun> runs(count);
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t each = count, rest = k;
      std::vector<std::string> names;
      for (const Axis& axis : axes_) {
        each /= axis[0].list.size();
        for (const Swept& one : axis) give(runs[k], one.key, one.list[rest / each]);
        names.push_back(name_of(axis[0].list[rest / each].text, rest / each));
        rest %= each;
      }
      runs[k].name = fmt::format("{}", fmt::join(names, "_"));
      constexpr std::size_t longest = 100;  // of a folder's name systems take 255
      if (runs[k].name.size() > longest) runs[k].name = fmt::format("{:05}", k + 1);
    }
    return runs;
  }

  std::vector<SweepRun> sampled() const {
    std::vector<SweepRun> runs(static_cast<std::size_t>(sample_->at("count")));
    const auto points = latin_hypercube(runs.size(), axes_.size(), static_cast<std::uint64_t>(sample_->at("seed")));
    for (std::size_t k = 0; k < runs.size(); ++k) {
      runs[k].name = fmt::format("{:05}", k + 1);
      for (std::size_t axis = 0; axis < axes_.size(); ++axis)
        for (const Swept& one : axes_[axis]) give(runs[k], one.key, one.sampled(points[k][axis]));
    }
    return runs;
  }

  Reading &reading_, values_;  // the second is a copy, to try single values on
  Where source_;
  const std::vector<std::string>& variants_;
  std::optional<Numbers> sample_;
  std::set<std::string> paths_;
  std::vector<Axis> axes_;
};

}  // namespace

std::vector<SweepRun> take_sweep(Reading& reading, const toml::node& sweep, const Where& source,
                                 const std::vector<std::string>& variants) {
  return SweepReader(reading, source, variants).read(sweep);
}

std::vector<std::vector<double>> latin_hypercube(std::size_t count, std::size_t axes, std::uint64_t seed) {
  std::mt19937_64 random(seed);  // the standard says its numbers, but not those of its distributions
  const auto below = [&](std::uint64_t bound) {
    std::uint64_t number = random();
    while (number >= random.max() - random.max() % bound) number = random();
    return number % bound;
  };
  std::vector<std::vector<double>> points(count, std::vector<double>(axes));
  std::vector<std::size_t> stratum(count);
  for (std::size_t axis = 0; axis < axes; ++axis) {
    std::iota(stratum.begin(), stratum.end(), std::size_t{0});
    for (std::size_t k = count; k > 1; --k) std::swap(stratum[k - 1], stratum[below(k)]);
    for (std::size_t k = 0; k < count; ++k) {
      const double within = static_cast<double>(random() >> 11) * 0x1p-53;
      points[k][axis] = (static_cast<double>(stratum[k]) + within) / static_cast<double>(count);
    }
  }
  return points;
}

}  // namespace strata
