#include "scene/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <set>

#include "scene/reading.hpp"

namespace strata {
namespace {

constexpr double most_runs = 10000;  // each run's scene is read, in a tenth of a millisecond
constexpr double largest = std::numeric_limits<double>::max();

// Values of a key from one to another, evenly spaced or in even ratios.
struct Range {
  double from = 0.0, to = 0.0, count = 0.0, is_log = 0.0;

  // Rounded to six digits, so that no machine's power function shows; the ends are as they were given.
  double at(double share) const {
    if (share <= 0.0 || share >= 1.0) return share <= 0.0 ? from : to;
    const double value = is_log != 0.0 ? from * std::pow(to / from, share) : from + share * (to - from);
    return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
  }
};

struct Sample {
  double count = 0.0, seed = 0.0, method = 0.0;
};

// A key that runs differ in, by a list or else a range.
struct Swept {
  std::string key;
  Where where;
  std::vector<SweepValue> list;
  Range range;

  std::size_t count() const { return list.empty() ? static_cast<std::size_t>(range.count) : list.size(); }
  SweepValue at_share(double share) const {
    if (list.empty()) return {key, number_text(range.at(share)), where};
    const auto size = static_cast<double>(list.size());
    return list[static_cast<std::size_t>(std::min(share * size, size - 1.0))];
  }
  SweepValue at_number(std::size_t k) const {
    return list.empty() ? at_share(static_cast<double>(k) / (range.count - 1.0)) : list[k];
  }
};

using Axis = std::vector<Swept>;  // keys that move together

// An entry of a range or a sample, and where its number, or that of its word, goes.
struct Entry {
  Key key;
  double& number;
};

Key number(std::string_view name, Bounds bounds) {
  return {Key::Kind::number, name, {}, "", "", bounds, "", "", "", true};
}
Key word(std::string_view name, std::string_view words) {
  return {Key::Kind::word, name, {}, "", "", {}, words};
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

// A value as part of a folder's name: 3e6 as 3000000, "weak" as weak, a list as its number.
std::string name_of(const SweepValue& value, std::size_t number) {
  std::string text = value.value.ends_with(".0") ? value.value.substr(0, value.value.size() - 2) : value.value;
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
      take_keys(*table, "", nullptr);
      if (const toml::node* together = table->get("together")) take_together(*together);
    }
    reading_.faults.insert(reading_.faults.end(), values_.faults.begin(), values_.faults.end());
    if (reading_.faults.size() > before) return {};
    std::ranges::sort(axes_, {}, [](const Axis& axis) { return std::pair(axis[0].where.line, axis[0].where.column); });
    if (sampled_) return sampled();
    double count = 1.0;
    for (const Axis& axis : axes_) count *= static_cast<double>(axis[0].count());
    if (count <= most_runs) return product(static_cast<std::size_t>(count));
    reading_.fault(at(sweep), "sweep makes {} runs, at most {} can be. Give fewer values, or sample them.", count,
                   most_runs);
    return {};
  }

 private:
  // Where something stands; like --set it lies above scene and variant.
  Where at(const toml::node& node) const {
    const Where where = where_of(source_, node.source());
    return {where.source, 2, where.line, where.column};
  }

  // The keys of a table as axes, or as one where they are to be one.
  void take_keys(const toml::table& table, const std::string& prefix, Axis* together) {
    for (const auto& [name, value] : table) {
      const std::string path = prefix.empty() ? std::string(name.str()) : fmt::format("{}.{}", prefix, name.str());
      if (together == nullptr && (path == "sample" || path == "together")) continue;
      const bool is_key = path == "variant" || find_key(path) != nullptr, is_table = !names_in_table(path).empty();
      Where where = where_of(source_, name.source());
      where.rank = 2;
      const std::string meant = prefix.empty() ? did_you_mean(path, {"together", "sample", "variant"}) : "";
      if (!is_key && !is_table && !meant.empty()) {
        reading_.fault(where, "unknown key sweep.{}.{}", path, meant);
      } else if (!is_key && !is_table) {
        take_value(values_, path, value, where);  // which says what is wrong
      } else if (value.is_table() && !is_key) {
        take_keys(*value.as_table(), path, together);
      } else {
        if (!paths_.insert(path).second) reading_.fault(where, "sweep has {} twice. Remove one.", path);
        Swept one{path, where, {}, {}};
        take_values(one, value);
        if (together == nullptr) axes_.push_back({one});
        if (together != nullptr) together->push_back(one);
      }
    }
  }

  void take_values(Swept& one, const toml::node& values) {
    const toml::array* list = values.as_array();
    if (values.is_table()) return take_range(one, *values.as_table());
    if (list == nullptr || list->empty())
      return reading_.fault(at(values),
                            "sweep.{} = {} is neither a list of values nor a range {{from, to, count}}. What is the "
                            "same in all runs stands outside [sweep].",
                            one.key, as_typed(values));
    std::set<std::string> names;
    for (const toml::node& value : *list) {
      one.list.push_back({one.key, as_one_line(value), at(value)});
      try_value(one.key, value, at(value));
      if (!names.insert(name_of(one.list.back(), names.size())).second)
        reading_.fault(at(value), "sweep.{} has {} twice. Remove one.", one.key, as_typed(value));
    }
  }

  // One value by itself, by the rules of its key.
  void try_value(const std::string& key, const toml::node& value, const Where& where) {
    if (key != "variant") return take_value(values_, key, value, where);
    const std::string name = value.value_or(std::string());
    if (std::ranges::find(variants_, name) == variants_.end())
      reading_.fault(where, "sweep.variant = {} is no variant. There is {}.{}", as_typed(value),
                     variants_.empty() ? "none" : joined(variants_), did_you_mean(name, variants_));
  }

  // The entries of a range or a sample; whether all that must be there are, and are of use.
  bool take_entries(const toml::table& table, const std::string& of, const std::vector<Entry>& entries) {
    const std::size_t before = reading_.faults.size();
    std::vector<std::string> names;
    for (const auto& [key, into] : entries) {
      names.emplace_back(key.path);
      const toml::node* node = table.get(key.path);
      if (node == nullptr && key.required) reading_.fault(at(table), "{}.{} is missing.", of, key.path);
      if (node == nullptr) continue;
      const Value value{fmt::format("{}.{}", of, key.path), key, *node, at(*node), reading_.faults};
      int of_word = 0;
      const bool integer = key.path == "count" || key.path == "seed";
      if (key.kind == Key::Kind::number && strata::read(value, into) && integer && !node->is_integer())
        value.faults.push_back({value.where, fmt::format("{} = {} is no integer.", value.path, as_typed(*node))});
      if (key.kind == Key::Kind::word && read_word(value, key.allowed, of_word)) into = of_word;
    }
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::ranges::find(names, name) == names.end())
        reading_.fault(at(node), "unknown key {}.{}. It has {}.{}", of, name, joined(names), did_you_mean(name, names));
    }
    return reading_.faults.size() == before;
  }

  void take_range(Swept& one, const toml::table& table) {
    const std::string of = "sweep." + one.key;
    auto& [from, to, count, is_log] = one.range;
    const Bounds above{table["scale"].value_or(std::string()) == "log" ? 0.0 : -largest};
    std::vector<Entry> entries{
        {number("from", above), from}, {number("to", above), to}, {word("scale", "linear, log"), is_log}};
    if (!sampled_) entries.push_back({number("count", {2.0, most_runs, false, false}), count});
    if (!take_entries(table, of, entries)) return;
    for (const double end : {from, to}) try_value(one.key, toml::value<double>(end), at(table));
    for (std::size_t k = 0; k == 0 || k + 1 < one.count(); ++k) {
      if (from != to && (sampled_ || one.at_number(k).value != one.at_number(k + 1).value)) continue;
      return reading_.fault(at(table), "{} has {} twice: values have six digits.", of, one.range.at(0.0));
    }
  }

  void take_sample(const toml::node& node) {
    auto& [count, seed, method] = sampled_.emplace();
    if (!node.is_table())
      return reading_.fault(at(node), "sweep.sample = {} is not a table. Write {{method, count, seed}}.",
                            as_typed(node));
    take_entries(*node.as_table(), "sweep.sample",
                 {{word("method", "latin_hypercube"), method},
                  {number("count", {2.0, most_runs, false, false}), count},
                  {number("seed", {0.0, 0x1p53, false, false}), seed}});
  }

  void take_together(const toml::node& node) {
    if (!node.is_array_of_tables())
      return reading_.fault(at(node), "sweep.together is not a list of tables. Write [[sweep.together]] above keys.");
    for (const toml::node& table : *node.as_array()) {
      Axis axis;
      take_keys(*table.as_table(), "", &axis);
      if (axis.empty()) continue;
      std::ranges::sort(axis, {}, [](const Swept& one) { return std::pair(one.where.line, one.where.column); });
      for (const Swept& one : axis) {
        if (!sampled_ && one.count() != axis[0].count())
          reading_.fault(one.where, "sweep.{} has {} values, and {}, with which it goes together, {}.", one.key,
                         one.count(), axis[0].key, axis[0].count());
      }
      axes_.push_back(axis);
    }
  }

  static void give(SweepRun& run, const SweepValue& value) {
    if (value.key != "variant") return run.values.push_back(value);
    run.variant = value.value.substr(1, value.value.size() - 2);
  }

  std::vector<SweepRun> product(std::size_t count) const {
    std::vector<SweepRun> runs(count);
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t each = count, rest = k;
      std::vector<std::string> names;
      for (const Axis& axis : axes_) {
        each /= axis[0].count();
        const std::size_t number = rest / each;
        rest %= each;
        for (const Swept& one : axis) give(runs[k], one.at_number(number));
        names.push_back(name_of(axis[0].at_number(number), number));
      }
      runs[k].name = fmt::format("{}", fmt::join(names, "_"));
      constexpr std::size_t longest = 100;  // of a folder's name systems take 255
      if (runs[k].name.size() > longest) runs[k].name = fmt::format("{:05}", k + 1);
    }
    return runs;
  }

  std::vector<SweepRun> sampled() const {
    std::vector<SweepRun> runs(static_cast<std::size_t>(sampled_->count));
    const auto points = latin_hypercube(runs.size(), axes_.size(), static_cast<std::uint64_t>(sampled_->seed));
    for (std::size_t k = 0; k < runs.size(); ++k) {
      runs[k].name = fmt::format("{:05}", k + 1);
      for (std::size_t axis = 0; axis < axes_.size(); ++axis)
        for (const Swept& one : axes_[axis]) give(runs[k], one.at_share(points[k][axis]));
    }
    return runs;
  }

  Reading &reading_, values_;  // the second is a copy, to try single values on
  Where source_;
  const std::vector<std::string>& variants_;
  std::optional<Sample> sampled_;
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
