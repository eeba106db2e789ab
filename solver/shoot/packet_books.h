#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "solver/shoot/transport_scene.h"
#include "solver/tally/batch_books.h"

namespace reemit {

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
  }

 private:
  BatchBooks& books_;
  std::vector<std::int64_t> escaped_;
};

}  // namespace reemit
