#include "solver/shoot/allocation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <tbb/parallel_for.h>

#include "solver/shoot/packet_books.h"

namespace reemit {

Allocation::Allocation(std::size_t zones, Channels channels, const std::vector<std::uint8_t>& needs)
    : values_(channels.count()),
      needs_(needs),
      chunks_((zones + kChunkBlocks * SweepAccounts::kBlockZones - 1) /
              (kChunkBlocks * SweepAccounts::kBlockZones)) {}

std::size_t Allocation::class_of(const SweepAccounts& accounts, std::size_t zone) const {
  double need = needs_.empty() ? 1 : needs_[zone];
  if (!accounts.arrived.empty() && accounts.arrived[zone].power > 0) {
    const SweepAccounts::Arrived& a = accounts.arrived[zone];
    need = std::max(need, packet_power_ * static_cast<double>(a.packets) / static_cast<double>(a.power));
  }
  return static_cast<std::size_t>(
      std::clamp(std::lround(std::log2(need)), 0L, static_cast<long>(kClasses) - 1));
}

template <class Visit>
void Allocation::for_live_blocks(std::size_t chunk, const SweepAccounts& accounts, const Visit& visit) {
  const std::size_t end = std::min(accounts.block_count(), (chunk + 1) * kChunkBlocks);
  for (std::size_t block = chunk * kChunkBlocks; block < end; ++block)
    if (accounts.live[block] != 0) visit(block);
}

double Allocation::measure(const SweepAccounts& accounts, double packet_power) {
  packet_power_ = packet_power;
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
    ByClass<std::int64_t> power{};
    for_live_blocks(c, accounts, [&](std::size_t block) {
      const auto at = [&](std::size_t zone) {
        return accounts.unshot.begin() + static_cast<std::ptrdiff_t>(zone * values_);
      };
      if (used_classes(accounts) == 1) {
        power[0] = std::accumulate(at(accounts.block_begin(block)), at(accounts.block_end(block)), power[0]);
        return;
      }
      for (std::size_t z = accounts.block_begin(block); z < accounts.block_end(block); ++z)
        if (const std::int64_t own = std::accumulate(at(z), at(z + 1), std::int64_t{0}); own > 0)
          power[class_of(accounts, z)] += own;
    });
    chunks_[c].power = power;
  });
  power_ = {};
  double measured = 0;
  for (std::size_t k = 0; k < kClasses; ++k) {
    for (Chunk& chunk : chunks_) {
      chunk.before[k] = power_[k];
      power_[k] += chunk.power[k];
    }
    measured += std::ldexp(static_cast<double>(power_[k]), static_cast<int>(k));
  }
  return measured;
}

void Allocation::plan(SweepAccounts& accounts, double quantum, double offset, Flight& flight,
                      BatchBooks& books) {
  for (std::size_t k = 0; k < kClasses; ++k) {
    const auto power = static_cast<double>(power_[k]);
    quantum_[k] = power / std::max(1.0, std::round(std::ldexp(power, static_cast<int>(k)) / quantum));
  }
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) { choose(c, accounts, offset); });
  flight.clear();
  for (const Chunk& chunk : chunks_)
    for (const Chosen& c : chunk.chosen) flight.add({ZoneId(c.zone), 0}, c.packets);
  flight.quanta.assign(flight.sources.size() * values_, 0);
  std::vector<ByClass<bool>> exchanged(values_);
  for (std::size_t c = 0; c < values_; ++c) hand_over(accounts.unshot, c, flight, books, exchanged[c]);
  drop_passed_over(accounts, exchanged, books);
}

void Allocation::choose(std::size_t chunk_index, const SweepAccounts& accounts, double offset) {
  Chunk& chunk = chunks_[chunk_index];
  chunk.chosen.clear();
  const std::size_t classes = used_classes(accounts);
  chunk.small_total.assign(classes * values_, 0);
  chunk.small_wanted.assign(classes * values_, 0);
  // The running sums are integers, so they are the same wherever a chunk begins.
  ByClass<std::int64_t> running = chunk.before;
  ByClass<double> before{};
  for (std::size_t k = 0; k < classes; ++k)
    if (power_[k] > 0) before[k] = std::floor(static_cast<double>(running[k]) / quantum_[k] + offset);
  for_live_blocks(chunk_index, accounts, [&](std::size_t block) {
    for (std::size_t z = accounts.block_begin(block); z < accounts.block_end(block); ++z) {
      const std::int64_t* own = &accounts.unshot[z * values_];
      const std::int64_t power = std::accumulate(own, own + values_, std::int64_t{0});
      if (power == 0) continue;
      const std::size_t k = classes == 1 ? 0 : class_of(accounts, z);
      running[k] += power;
      const double upto = std::floor(static_cast<double>(running[k]) / quantum_[k] + offset);
      const auto packets = static_cast<std::uint32_t>(upto - before[k]);
      before[k] = upto;
      const bool small = static_cast<double>(power) < quantum_[k] || packets == 0;
      const double growth = small ? quantum_[k] * packets / static_cast<double>(power) : 0.0;
      if (small)
        for (std::size_t c = 0; c < values_; ++c) {
          chunk.small_total[k * values_ + c] += own[c];
          chunk.small_wanted[k * values_ + c] += static_cast<double>(own[c]) * growth;
        }
      if (packets > 0)
        chunk.chosen.push_back(
            {static_cast<std::uint32_t>(z), packets, static_cast<std::uint32_t>(k), growth});
    }
  });
}

void Allocation::hand_over(std::vector<std::int64_t>& unshot, std::size_t channel, Flight& flight,
                           BatchBooks& books, ByClass<bool>& exchanged) const {
  struct Exchange {
    std::int64_t total = 0;
    double wanted = 0;
    double running = 0;
    std::int64_t given = 0;
    std::int64_t* last_taker = nullptr;
  };
  ByClass<Exchange> exchanges{};
  for (const Chunk& chunk : chunks_)
    for (std::size_t k = 0; k * values_ < chunk.small_total.size(); ++k) {
      exchanges[k].total += chunk.small_total[k * values_ + channel];
      exchanges[k].wanted += chunk.small_wanted[k * values_ + channel];
    }
  std::size_t source = 0;
  for (const Chunk& chunk : chunks_)
    for (const Chosen& c : chunk.chosen) {
      Exchange& x = exchanges[c.of_class];
      std::int64_t& own = unshot[c.zone * values_ + channel];
      std::int64_t& sent = flight.quanta[source++ * values_ + channel];
      sent = own;
      if (c.growth > 0 && x.wanted > 0 && own > 0) {
        x.running += static_cast<double>(own) * c.growth;
        const std::int64_t until =
            std::llround(std::min(1.0, x.running / x.wanted) * static_cast<double>(x.total));
        sent = until - x.given;
        x.given = until;
        (sent > own ? books.roulette_gain[channel] : books.roulette_loss[channel]) += std::abs(sent - own);
        x.last_taker = &sent;
        if (static_cast<double>(x.total) > kUsualRoulette * x.wanted)
          books.events.roulette_jumps += c.packets;
      }
      own = 0;
    }
  for (std::size_t k = 0; k < kClasses; ++k) {
    // Where no chosen small zone has power in this channel there is nobody to hand over to, and all keep what
    // they have.
    Exchange& x = exchanges[k];
    exchanged[k] = x.wanted > 0;
    if (!exchanged[k]) continue;
    // The rounding of the running sum may leave a quantum or two.
    *x.last_taker += x.total - x.given;
    books.roulette_gain[channel] += x.total - x.given;
  }
}

void Allocation::drop_passed_over(SweepAccounts& accounts, const std::vector<ByClass<bool>>& exchanged,
                                  BatchBooks& books) const {
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
    std::vector<std::int64_t> dropped(values_, 0);
    for_live_blocks(c, accounts, [&](std::size_t block) {
      bool live = false;
      for (std::size_t z = accounts.block_begin(block); z < accounts.block_end(block); ++z)
        for (std::size_t i = 0; i < values_; ++i) {
          std::int64_t& own = accounts.unshot[z * values_ + i];
          if (own == 0) continue;
          const std::size_t k = used_classes(accounts) == 1 ? 0 : class_of(accounts, z);
          live = live || !exchanged[i][k];
          if (!exchanged[i][k]) continue;
          dropped[i] += own;
          own = 0;
        }
      if (!live) accounts.live[block] = 0;
    });
    for (std::size_t i = 0; i < values_; ++i)
      if (dropped[i] != 0) book(books.roulette_loss[i], dropped[i]);
  });
}

}  // namespace reemit
