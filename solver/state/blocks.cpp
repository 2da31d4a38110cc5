#include "state/blocks.hpp"

#include <algorithm>
#include <bit>
#include <compare>
#include <numeric>

#include "state/lanes.hpp"

namespace strata {

namespace {

struct Numbering {
  SideWord key;
  int node, record;
  auto operator<=>(const Numbering&) const = default;  // NOLINT(modernize-use-nullptr)
};

bool beside(const Bin& bin, const Bin& next) {
  if (next.j != bin.j || next.i != bin.i + 1) return false;
  for (std::size_t n = 0; n < 9; ++n) {
    if (next.record[n] != bin.record[n] + 1) return false;
  }
  return true;
}

struct BlockBuilder {
  const std::vector<std::uint8_t>& rock;  // of the particles, bin by bin
  std::vector<Bin> bins{};
  std::vector<std::size_t> order{};

  std::uint8_t rock_of(const Bin& bin, int k) const { return rock[static_cast<std::size_t>(bin.first + k)]; }

  // How many particles, from the first one on, all bins have with the same rocks.
  int shared(const Bin* run, int lanes) const {
    int n = run[0].last - run[0].first;
    for (int l = 1; l < lanes; ++l) {
      const int most = std::min(n, run[l].last - run[l].first);
      for (n = 0; n < most && rock_of(run[l], n) == rock_of(run[0], n);) ++n;
    }
    return n;
  }

  void add_block(const Bin* run, int lanes, int n) {
    const auto start = static_cast<int>(order.size());
    for (int k = 0; k < n; ++k) {
      for (int l = 0; l < lanes; ++l) order.push_back(static_cast<std::size_t>(run[l].first + k));
    }
    for (int l = 0; l < lanes; ++l) {
      Bin bin = run[l];
      bin.first = start + l, bin.last = bin.first + n * lanes, bin.stride = lanes;
      bins.push_back(bin);
    }
  }

  // Bins each beside the next, first the ones with the particles that a block shares and then their rests.
  void add_run(const std::vector<Bin>& run) {
    std::vector<Bin> rest;
    for (std::size_t b = 0; b < run.size();) {
      const Bin* at = run.data() + b;
      int lanes = static_cast<int>(std::bit_floor(std::min<std::size_t>(most_lanes, run.size() - b)));
      while (shared(at, lanes) == 0) lanes /= 2;
      const int n = shared(at, lanes);
      add_block(at, lanes, n);
      for (int l = 0; l < lanes; ++l) {
        Bin more = at[l];
        more.first += n;
        if (more.first < more.last) rest.push_back(more);
      }
      b += static_cast<std::size_t>(lanes);
    }
    add_bins(rest);
  }

  void add_bins(const std::vector<Bin>& all) {
    for (std::size_t b = 0; b < all.size();) {
      std::size_t end = b + 1;
      while (end < all.size() && beside(all[end - 1], all[end])) ++end;
      add_run({all.begin() + static_cast<std::ptrdiff_t>(b), all.begin() + static_cast<std::ptrdiff_t>(end)});
      b = end;
    }
  }
};

}  // namespace

void number_along_rows(Copies& copies, std::vector<Bin>& bins) {
  const int nodes = static_cast<int>(copies.cut_of_node.size());
  std::vector<Numbering> further;
  for (const CutNode& cut : copies.cut) {
    for (std::size_t k = 0; k < cut.keys.size(); ++k) {
      if (cut.records[k] < nodes) continue;
      further.push_back({cut.keys[k], copies.node(cut.records[k]), cut.records[k]});
    }
  }
  std::ranges::sort(further);
  std::vector<int> number(copies.node_of_record.size());
  std::iota(number.begin(), number.end(), 0);
  for (std::size_t k = 0; k < further.size(); ++k) {
    number[static_cast<std::size_t>(further[k].record)] = nodes + static_cast<int>(k);
    copies.node_of_record[static_cast<std::size_t>(nodes) + k] = further[k].node;
  }
  copies.node_of_record.resize(static_cast<std::size_t>(nodes) + further.size());  // without what has been joined
  for (CutNode& cut : copies.cut) {
    for (int& record : cut.records) record = number[static_cast<std::size_t>(record)];
  }
  for (Bin& bin : bins) {
    for (int& record : bin.record) record = number[static_cast<std::size_t>(record)];
  }
}

std::vector<std::size_t> make_blocks(const std::vector<std::uint8_t>& rock, std::vector<Bin>& bins) {
  BlockBuilder builder{rock};
  // At cut nodes there are bins of one place on both sides of a surface: a row at a time, sorted so that those beside
  // each other, whose records less their columns are the same, follow each other.
  const auto order_of = [](const Bin& bin) {
    auto records = bin.record;
    for (int& record : records) record -= bin.i;
    return std::make_pair(records, bin.i);
  };
  for (std::size_t b = 0; b < bins.size();) {
    std::size_t end = b;
    while (end < bins.size() && bins[end].j == bins[b].j) ++end;
    std::vector<Bin> row(bins.begin() + static_cast<std::ptrdiff_t>(b),
                         bins.begin() + static_cast<std::ptrdiff_t>(end));
    std::sort(row.begin(), row.end(), [&](const Bin& x, const Bin& y) { return order_of(x) < order_of(y); });
    builder.add_bins(row);
    b = end;
  }
  bins.swap(builder.bins);
  return builder.order;
}

}  // namespace strata
