#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "solver/shoot/packet_room.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// Counts one of what is rare enough for all threads to count in one place.
inline void count_event(std::uint64_t& events) {
  std::atomic_ref<std::uint64_t>(events).fetch_add(1, std::memory_order_relaxed);
}

/// Accounts of one task for ends of packets that many packets share, so that threads do not contend for them.
/// They reach the books when the object goes.
class LocalBooks {
 public:
  explicit LocalBooks(BatchBooks& books) : books_(books), escaped_(books.escaped.size()) {}
  LocalBooks(const LocalBooks&) = delete;
  LocalBooks& operator=(const LocalBooks&) = delete;
  ~LocalBooks() {
    for (std::size_t i = 0; i < escaped_.size(); ++i)
      if (escaped_[i] != 0) book(books_.escaped[i], escaped_[i]);
  }

  /// Power that left the room in direction (x,y,z), booked under the nearest axis.
  void escape(float x, float y, float z, std::size_t band, std::int64_t quanta) {
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
    escaped_[axis * books_.bands + band] += quanta;
    if (band == 0) count_event(books_.events.escapes);
  }

 private:
  BatchBooks& books_;
  std::vector<std::int64_t> escaped_;
};

/// 16 rays with what their packets carry.
struct PacketBlock {
  explicit PacketBlock(std::size_t bands) : power(16 * bands) {}
  int count = 0;
  Ray16 rays{};
  std::uint32_t id[16] = {};
  std::vector<std::int64_t> power;  ///< [lane * bands + band]
};

/// Packets whose rays ended in doubt (RayTracer::is_doubtful), waiting for their second look until there are
/// enough for a block: traced one by one beside others, they would cost as much as a whole block.
class DoubtfulPackets {
 public:
  explicit DoubtfulPackets(std::size_t bands) : bands_(bands) {}

  std::size_t count() const { return id_.size(); }

  void add(const RayTracer& scene, const Ray16& rays, const Hit16& hits, int lane, std::uint32_t id,
           const std::int64_t* power) {
    origin_.push_back(rays.origin(lane));
    direction_.push_back(scene.second_direction(rays.direction(lane), hits, lane));
    id_.push_back(id);
    power_.insert(power_.end(), power, power + bands_);
  }

  /// Moves the last 16 packets, or as many as there are, into `block`, with the rays of their second look.
  void take(PacketBlock& block) {
    block.count = static_cast<int>(std::min<std::size_t>(16, count()));
    for (int lane = 0; lane < block.count; ++lane) {
      block.rays.set(lane, origin_.back(), direction_.back());
      block.id[lane] = id_.back();
      std::copy(power_.end() - static_cast<std::ptrdiff_t>(bands_), power_.end(),
                block.power.begin() + lane * static_cast<std::ptrdiff_t>(bands_));
      origin_.pop_back();
      direction_.pop_back();
      id_.pop_back();
      power_.resize(power_.size() - bands_);
    }
  }

 private:
  std::size_t bands_;
  std::vector<Vec3f> origin_;
  std::vector<Vec3f> direction_;
  std::vector<std::uint32_t> id_;
  std::vector<std::int64_t> power_;
};

}  // namespace reemit
