#pragma once

// Field numbers and values in the schema of the Open Vector Format, as far as the writer and the reader use
// them. Namespaces are nested like the messages of the schema.

#include <cstdint>
#include <string_view>

namespace lamella::ovf {

/// The magic at the beginning of the file. The offset of the file's last message follows it.
inline constexpr std::string_view magic = "LVF!";

namespace job {
enum : std::uint32_t { meta_data = 2, marking_params = 3, parts = 4, work_plane_count = 6 };
namespace meta {
enum : std::uint32_t { bounds = 6 };
} // namespace meta
} // namespace job

namespace box {
enum : std::uint32_t { x_min = 1, y_min = 2, x_max = 3, y_max = 4 };
} // namespace box

namespace map_entry {
enum : std::uint32_t { key = 1, value = 2 };
} // namespace map_entry

namespace marking {
enum : std::uint32_t {
    power_w = 1,
    speed_mm_s = 2,
    focus_mm = 3,
    jump_speed_mm_s = 5,
    jump_delay_us = 11,
    mark_delay_us = 14,
    name = 26
};
} // namespace marking

namespace part {
enum : std::uint32_t { name = 1, strategy = 4 };
namespace strategy_of_part {
enum : std::uint32_t { layer_thickness_mm = 5 };
} // namespace strategy_of_part
} // namespace part

namespace work_plane {
enum : std::uint32_t {
    x = 2,
    y = 3,
    z = 4,
    x_turn = 5,
    y_turn = 6,
    z_turn = 7,
    block_count = 8,
    repeats = 9,
    number = 10
};
} // namespace work_plane

namespace block {
enum : std::uint32_t {
    line_sequence = 1,
    hatches = 2,
    last_of_vectors = 12, ///< largest field number of a kind of vectors; the numbers between those above are
                          ///< other kinds
    marking_params_key = 50,
    laser_index = 53,
    repeats = 54,
    meta_data = 100,
    lpbf_meta_data = 101
};
/// Fields of line sequences and hatches.
enum : std::uint32_t { points = 1 };
namespace meta {
enum : std::uint32_t { part_key = 3 };
} // namespace meta
namespace lpbf {
enum : std::uint32_t { part_area = 1, skin_type = 2, structure_type = 4 };
enum : std::uint8_t { volume = 0, contour = 1, transition_contour = 2 };
enum : std::uint8_t { in_skin = 0, down_skin = 1, up_skin = 2 };
enum : std::uint8_t { of_part = 0, of_support = 1 };
} // namespace lpbf
} // namespace block

/// Tables of the offsets of messages: those of the job, and those of each work plane.
namespace table {
enum : std::uint32_t { shell = 1, positions = 2 };
} // namespace table

} // namespace lamella::ovf
