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

template <class Visit>
void Allocation::for_live_blocks(std::size_t chunk, const SweepAccounts& accounts, const Visit& visit) {
  const std::size_t end = std::min(accounts.block_count(), (chunk + 1) * kChunkBlocks);
  for (std::size_t block = chunk * kChunkBlocks; block < end; ++block)
    if (accounts.live[block] != 0) visit(block);
}

std::int64_t Allocation::measure(const SweepAccounts& accounts) {
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
    std::int64_t power = 0;
    for_live_blocks(c, accounts, [&](std::size_t block) {
      const std::int64_t* unshot = accounts.unshot.data();
      if (!needs_.empty()) {
        for (std::size_t z = accounts.block_begin(block); z < accounts.block_end(block); ++z)
          power +=
              need(z) * std::accumulate(unshot + z * values_, unshot + (z + 1) * values_, std::int64_t{0});
        return;
      }
      power = std::accumulate(unshot + accounts.block_begin(block) * values_,
                              unshot + accounts.block_end(block) * values_, power);
    });
    chunks_[c].power = power;
  });
  std::int64_t running = 0;
  for (Chunk& chunk : chunks_) {
    chunk.before = running;
    running += chunk.power;
  }
  return running;
}

void Allocation::plan(SweepAccounts& accounts, double quantum, double offset, Flight& flight,
                      BatchBooks& books) {
  tbb::parallel_for(std::size_t{0}, chunks_.size(),
                    [&](std::size_t c) { choose(c, accounts, quantum, offset); });
  flight.clear();
  for (const Chunk& chunk : chunks_)
    for (const Chosen& c : chunk.chosen) flight.add({ZoneId(c.zone), 0}, c.packets);
  flight.quanta.assign(flight.sources.size() * values_, 0);
  std::vector<bool> exchanged(values_);
  for (std::size_t c = 0; c < values_; ++c) exchanged[c] = hand_over(accounts.unshot, c, flight, books);
  drop_passed_over(accounts, exchanged, books);
}

void Allocation::choose(std::size_t chunk_index, const SweepAccounts& accounts, double quantum,
                        double offset) {
  Chunk& chunk = chunks_[chunk_index];
  chunk.chosen.clear();
  chunk.small_total.assign(values_, 0);
  chunk.small_wanted.assign(values_, 0);
  if (chunk.power == 0) return;
  // The running sum is an integer, so it is the same wherever a chunk begins.
  std::int64_t running = chunk.before;
  double before = std::floor(static_cast<double>(running) / quantum + offset);
  for_live_blocks(chunk_index, accounts, [&](std::size_t block) {
    for (std::size_t z = accounts.block_begin(block); z < accounts.block_end(block); ++z) {
      const std::int64_t* own = &accounts.unshot[z * values_];
      const std::int64_t power = std::accumulate(own, own + values_, std::int64_t{0});
      if (power == 0) continue;
      running += need(z) * power;
      const double own_quantum = quantum / static_cast<double>(need(z));
      const double upto = std::floor(static_cast<double>(running) / quantum + offset);
      const auto packets = static_cast<std::uint32_t>(upto - before);
      before = upto;
      const bool small = static_cast<double>(power) < own_quantum || packets == 0;
      const double growth = small ? own_quantum * packets / static_cast<double>(power) : 0.0;
      if (small)
        for (std::size_t c = 0; c < values_; ++c) {
          chunk.small_total[c] += own[c];
          chunk.small_wanted[c] += static_cast<double>(own[c]) * growth;
        }
      if (packets > 0) chunk.chosen.push_back({static_cast<std::uint32_t>(z), packets, growth});
    }
  });
}

bool Allocation::hand_over(std::vector<std::int64_t>& unshot, std::size_t channel, Flight& flight,
                           BatchBooks& books) const {
  std::int64_t total = 0;
  double wanted = 0;
  for (const Chunk& chunk : chunks_) {
    total += chunk.small_total[channel];
    wanted += chunk.small_wanted[channel];
  }
  // Where no chosen small zone has power in this channel there is nobody to hand over to, and all keep what
  // they have.
  const bool exchange = wanted > 0;
  const bool jumps = static_cast<double>(total) > kUsualRoulette * wanted;
  double running = 0;
  std::int64_t given = 0;
  std::size_t source = 0;
  std::int64_t* last_taker = nullptr;
  for (const Chunk& chunk : chunks_)
    for (const Chosen& c : chunk.chosen) {
      std::int64_t& own = unshot[c.zone * values_ + channel];
      std::int64_t& sent = flight.quanta[source++ * values_ + channel];
      sent = own;
      if (c.growth > 0 && exchange && own > 0) {
        running += static_cast<double>(own) * c.growth;
        const std::int64_t until = std::llround(std::min(1.0, running / wanted) * static_cast<double>(total));
        sent = until - given;
        given = until;
        (sent > own ? books.roulette_gain[channel] : books.roulette_loss[channel]) += std::abs(sent - own);
        last_taker = &sent;
        if (jumps) books.events.roulette_jumps += c.packets;
      }
      own = 0;
    }
  if (!exchange) return false;
  // The rounding of the running sum may leave a quantum or two.
  *last_taker += total - given;
  books.roulette_gain[channel] += total - given;
  return true;
}

void Allocation::drop_passed_over(SweepAccounts& accounts, const std::vector<bool>& exchanged,
                                  BatchBooks& books) const {
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
    std::vector<std::int64_t> dropped(values_, 0);
    for_live_blocks(c, accounts, [&](std::size_t block) {
      bool live = false;
      for (std::size_t z = accounts.block_begin(block); z < accounts.block_end(block); ++z)
        for (std::size_t i = 0; i < values_; ++i) {
          std::int64_t& own = accounts.unshot[z * values_ + i];
          if (own == 0) continue;
          live = live || !exchanged[i];
          if (!exchanged[i]) continue;
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
