#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace reemit::bench {

/// What grows with the number of triangles.
enum class Growth {
  kHall,    ///< The hall: ever more workplaces of about 1,300 triangles each, 2.6 m apart.
  kDetail,  ///< The detail: 48 workplaces in one hall, ever finer legs, bins, cups and lamp globes.
};

/// Writes a hall full of furniture as OBJ (with its MTL beside it): turned desks and chairs with round legs
/// that stand on the floor, pedestals under desks, bins, shelves of books against each other and screens,
/// cups and books on the tops, globes that hang from the ceiling, and luminaires set into it. Nothing lies on
/// a grid: places, angles and sizes are drawn from `seed`. Every fifth piece hovers 0.2 mm above what it
/// stands on, as drawn furniture does. Returns the triangles written: about `wanted`, and at least 54,000
/// when the detail grows.
std::size_t write_furnished_hall(const std::filesystem::path& file, std::size_t wanted, Growth growth,
                                 std::uint32_t seed);

}  // namespace reemit::bench
