#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <vector>

#include "solver/shoot/packet_room.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// Counts what is rare enough for all threads to count in one place.
inline void count_event(std::uint64_t& events, std::uint64_t times = 1) {
  std::atomic_ref<std::uint64_t>(events).fetch_add(times, std::memory_order_relaxed);
}

/// Roulette keeps the mean of what it makes larger; beyond this factor it is a RareEvents::roulette_jumps.
inline constexpr double kUsualRoulette = 2;

/// Accounts of one task for ends of packets that many packets share, and counts, so that threads do not
/// contend for them. They reach the books when the object goes.
class LocalBooks {
 public:
  explicit LocalBooks(BatchBooks& books) : books_(books), escaped_(books.escaped.size()) {}
  LocalBooks(const LocalBooks&) = delete;
  LocalBooks& operator=(const LocalBooks&) = delete;
  ~LocalBooks() {
    for (std::size_t i = 0; i < escaped_.size(); ++i)
      if (escaped_[i] != 0) book(books_.escaped[i], escaped_[i]);
    if (escapes_ != 0) count_event(books_.events.escapes, escapes_);
    if (second_looks_ != 0) count_event(books_.events.second_looks, second_looks_);
  }

  void count_second_look() { ++second_looks_; }

  /// Power that left the room in direction (x,y,z), booked under the nearest axis.
  void escape(float x, float y, float z, std::size_t channel, std::int64_t quanta) {
    const float ax = x < 0 ? -x : x;
    const float ay = y < 0 ? -y : y;
    const float az = z < 0 ? -z : z;
    std::size_t axis = 0;
    if (ax >= ay && ax >= az)
      axis = x < 0 ? 1 : 0;
    else if (ay >= az)
      axis = y < 0 ? 3 : 2;
    else
      axis = z < 0 ? 5 : 4;
    escaped_[axis * books_.channels.count() + channel] += quanta;
    if (channel == 0) ++escapes_;
  }

 private:
  BatchBooks& books_;
  std::vector<std::int64_t> escaped_;
  std::uint64_t escapes_ = 0;
  std::uint64_t second_looks_ = 0;
};

/// The part of the light that packets of the first sweep bring, in the order in which their ways change it.
enum class LightPart : std::uint8_t {
  kDirect,    ///< Straight from luminaires, also across panes.
  kCaustic,   ///< From luminaires over mirrors, glass and gloss.
  kIndirect,  ///< Scattered before.
};

/// How a packet came since it was last sent out by a source or a zone: over so many mirrors and panes.
struct SpecularWay {
  std::uint32_t steps = 0;
  LightPart part = LightPart::kDirect;  ///< What the way makes of direct light.
  TriangleId body;  ///< A face of the body of glass that it was sent into; not valid in air.
};

/// 16 rays with what their packets carry.
struct PacketBlock {
  explicit PacketBlock(Channels channels) : power(16 * channels.count()) {}
  int count = 0;
  Ray16 rays{};
  std::uint32_t id[16] = {};
  SpecularWay way[16] = {};
  std::vector<std::int64_t> power;  ///< [lane * channels + channel]

  /// Makes it one of packets first .. first+n-1, n <= 16.
  void number(std::uint32_t first, int n) {
    count = n;
    std::iota(id, id + 16, first);
  }
  std::int64_t* power_of(int lane) { return &power[static_cast<std::size_t>(lane) * (power.size() / 16)]; }
};

/// Packets that wait until there are enough for a block: those whose rays ended in doubt
/// (RayTracer::is_doubtful), for their second look, and those that go on from mirrors and panes. Traced one
/// by one beside others, they would cost as much as a whole block.
class WaitingPackets {
 public:
  explicit WaitingPackets(Channels channels) : values_(channels.count()) {}

  std::size_t count() const { return id_.size(); }

  void add(const Vec3f& origin, const Vec3f& direction, std::uint32_t id, const SpecularWay& way,
           const std::int64_t* power, std::uint32_t cut_out_key = 0) {
    cut_out_key_.push_back(cut_out_key);
    origin_.push_back(origin);
    direction_.push_back(direction);
    id_.push_back(id);
    way_.push_back(way);
    power_.insert(power_.end(), power, power + values_);
  }
  /// Adds a packet of a block for its second look.
  void add_doubtful(const RayTracer& scene, const PacketBlock& block, const Hit16& hits, int lane) {
    add(block.rays.origin(lane), scene.second_direction(block.rays.direction(lane), hits, lane),
        block.id[lane], block.way[lane], &block.power[static_cast<std::size_t>(lane) * values_],
        scene.cut_out_key(block.rays, lane));
  }
  void append(const WaitingPackets& more) {
    for (std::size_t i = 0; i < more.count(); ++i)
      add(more.origin_[i], more.direction_[i], more.id_[i], more.way_[i], &more.power_[i * values_],
          more.cut_out_key_[i]);
  }

  /// Moves those from `first` on whose way has gone beyond this part into `other`.
  void move_beyond(LightPart part, WaitingPackets& other, std::size_t first = 0) {
    std::size_t kept = first;
    for (std::size_t i = first; i < count(); ++i) {
      if (way_[i].part > part) {
        other.add(origin_[i], direction_[i], id_[i], way_[i], &power_[i * values_], cut_out_key_[i]);
        continue;
      }
      cut_out_key_[kept] = cut_out_key_[i];
      origin_[kept] = origin_[i];
      direction_[kept] = direction_[i];
      id_[kept] = id_[i];
      way_[kept] = way_[i];
      std::copy_n(&power_[i * values_], values_, &power_[kept * values_]);
      ++kept;
    }
    resize(kept);
  }
  /// Moves the last 16 packets, or as many as there are, into `block`.
  void take(PacketBlock& block) {
    const std::size_t left = count() - std::min<std::size_t>(16, count());
    copy(left, block);
    resize(left);
  }
  /// Copies packets `first` .. first+15, or as many as there are, into `block`.
  void copy(std::size_t first, PacketBlock& block) const {
    block.count = static_cast<int>(std::min<std::size_t>(16, count() - first));
    for (int lane = 0; lane < block.count; ++lane) {
      const std::size_t i = first + static_cast<std::size_t>(lane);
      block.rays.set(lane, origin_[i], direction_[i], cut_out_key_[i]);
      block.id[lane] = id_[i];
      block.way[lane] = way_[i];
      std::copy_n(&power_[i * values_], values_, &block.power[static_cast<std::size_t>(lane) * values_]);
    }
  }

 private:
  void resize(std::size_t count) {
    cut_out_key_.resize(count);
    origin_.resize(count);
    direction_.resize(count);
    id_.resize(count);
    way_.resize(count);
    power_.resize(count * values_);
  }

  std::size_t values_;                      // of each packet
  std::vector<std::uint32_t> cut_out_key_;  // as Ray16::key
  std::vector<Vec3f> origin_;
  std::vector<Vec3f> direction_;
  std::vector<std::uint32_t> id_;
  std::vector<SpecularWay> way_;
  std::vector<std::int64_t> power_;
};

}  // namespace reemit
