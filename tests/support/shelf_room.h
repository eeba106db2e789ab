#pragma once
#include "tests/support/test_rooms.h"

namespace reemit::test {

/// A box with a lamp under its ceiling and a shelf that throws a shadow.
inline RoomBuilder room_with_shelf() {
  RoomBuilder room;
  const MaterialId white = room.material("white", 0.7, 0, true);
  const MaterialId lamp = room.material("lamp", 0.5, 20);
  room.box({0, 0, 0}, {1, 1, 1}, {white, white, white, white, white, white}, 6);
  room.quad(lamp, {Vec3(0.3, 0.3, 0.98), Vec3(0.3, 0.6, 0.98), Vec3(0.7, 0.6, 0.98), Vec3(0.7, 0.3, 0.98)},
            3);
  room.quad(white, {Vec3(0.1, 0.1, 0.4), Vec3(0.6, 0.1, 0.4), Vec3(0.6, 0.5, 0.4), Vec3(0.1, 0.5, 0.4)}, 6);
  return room;
}

}  // namespace reemit::test
