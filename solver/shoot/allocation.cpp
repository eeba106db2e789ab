#include "solver/shoot/allocation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <tbb/parallel_for.h>

namespace reemit {

Allocation::Allocation(std::size_t zones, std::size_t bands)
    : zones_(zones), bands_(bands), chunks_((zones + kChunkZones - 1) / kChunkZones) {}

std::int64_t Allocation::measure(const std::vector<std::int64_t>& unshot) {
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
    const auto first = unshot.begin() + static_cast<std::ptrdiff_t>(c * kChunkZones * bands_);
    const auto last =
        unshot.begin() + static_cast<std::ptrdiff_t>(std::min(zones_, (c + 1) * kChunkZones) * bands_);
    chunks_[c].power = std::accumulate(first, last, std::int64_t{0});
  });
  std::int64_t running = 0;
  for (Chunk& chunk : chunks_) {
    chunk.before = running;
    running += chunk.power;
  }
  return running;
}

void Allocation::plan(std::vector<std::int64_t>& unshot, double quantum, double offset, Flight& flight,
                      BatchBooks& books) {
  tbb::parallel_for(std::size_t{0}, chunks_.size(),
                    [&](std::size_t c) { choose(chunks_[c], c * kChunkZones, unshot, quantum, offset); });
  flight.clear();
  for (const Chunk& chunk : chunks_)
    for (const Chosen& c : chunk.chosen) flight.add({ZoneId(c.zone), 0}, c.packets);
  flight.quanta.assign(flight.sources.size() * bands_, 0);
  for (std::size_t b = 0; b < bands_; ++b) hand_over(unshot, b, flight, books);
}

void Allocation::choose(Chunk& chunk, std::size_t first, const std::vector<std::int64_t>& unshot,
                        double quantum, double offset) const {
  chunk.chosen.clear();
  chunk.small_total.assign(bands_, 0);
  chunk.small_wanted.assign(bands_, 0);
  if (chunk.power == 0) return;
  // The running sum is an integer, so it is the same wherever a chunk begins.
  std::int64_t running = chunk.before;
  double before = std::floor(static_cast<double>(running) / quantum + offset);
  for (std::size_t z = first; z < std::min(zones_, first + kChunkZones); ++z) {
    const std::int64_t* own = &unshot[z * bands_];
    const std::int64_t power = std::accumulate(own, own + bands_, std::int64_t{0});
    if (power == 0) continue;
    running += power;
    const double upto = std::floor(static_cast<double>(running) / quantum + offset);
    const auto packets = static_cast<std::uint32_t>(upto - before);
    before = upto;
    const bool small = static_cast<double>(power) < quantum || packets == 0;
    const double growth = small ? quantum * packets / static_cast<double>(power) : 0.0;
    if (small)
      for (std::size_t b = 0; b < bands_; ++b) {
        chunk.small_total[b] += own[b];
        chunk.small_wanted[b] += static_cast<double>(own[b]) * growth;
      }
    if (packets > 0) chunk.chosen.push_back({static_cast<std::uint32_t>(z), packets, growth});
  }
}

void Allocation::hand_over(std::vector<std::int64_t>& unshot, std::size_t band, Flight& flight,
                           BatchBooks& books) const {
  std::int64_t total = 0;
  double wanted = 0;
  for (const Chunk& chunk : chunks_) {
    total += chunk.small_total[band];
    wanted += chunk.small_wanted[band];
  }
  // Where no chosen small zone has power in this band there is nobody to hand over to, and all keep what they
  // have.
  const bool exchange = wanted > 0;
  double running = 0;
  std::int64_t given = 0;
  std::size_t source = 0;
  std::int64_t* last_taker = nullptr;
  for (const Chunk& chunk : chunks_)
    for (const Chosen& c : chunk.chosen) {
      std::int64_t& own = unshot[c.zone * bands_ + band];
      std::int64_t& sent = flight.quanta[source++ * bands_ + band];
      sent = own;
      if (c.growth > 0 && exchange && own > 0) {
        running += static_cast<double>(own) * c.growth;
        const std::int64_t until = std::llround(std::min(1.0, running / wanted) * static_cast<double>(total));
        sent = until - given;
        given = until;
        (sent > own ? books.roulette_gain[band] : books.roulette_loss[band]) += std::abs(sent - own);
        last_taker = &sent;
      }
      own = 0;
    }
  if (!exchange) return;
  // The rounding of the running sum may leave a quantum or two.
  *last_taker += total - given;
  books.roulette_gain[band] += total - given;
  drop_passed_over(unshot, band, books);
}

void Allocation::drop_passed_over(std::vector<std::int64_t>& unshot, std::size_t band,
                                  BatchBooks& books) const {
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
    if (chunks_[c].power == 0) return;
    std::int64_t dropped = 0;
    for (std::size_t z = c * kChunkZones; z < std::min(zones_, (c + 1) * kChunkZones); ++z) {
      dropped += unshot[z * bands_ + band];
      unshot[z * bands_ + band] = 0;
    }
    if (dropped != 0) book(books.roulette_loss[band], dropped);
  });
}

}  // namespace reemit
