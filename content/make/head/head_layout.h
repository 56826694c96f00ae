#pragma once

#include "ecs/base/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

// Topology of the skin of a head: its vertices and the quads that connect them. kHeadColumns
// columns run around the head, column 0 down the midline of the face, then to the left; kHeadRows
// rows of quads from the rim of the crown to the end of the neck. A square cap closes the crown:
// its corners are poles of valence 3. A block of the grid around each eye, nostril and ear and the
// mouth is replaced by loops of as many vertices as the block has on its border: its corners become
// poles of valence 5.

inline constexpr int kHeadColumns = 96;
inline constexpr int kHeadRows = 86;

enum class HeadLoops : std::uint8_t { None, Eye, Nostril, Mouth, Ear };

struct HeadVertex {
    Vec3 start = {};  ///< initial position, before it is wrapped [cm]
    Vec2 chart = {};  ///< column and row, fractions within loops; the cap: row < 0
    HeadLoops loops = HeadLoops::None;  ///< that it is part of
    std::int16_t loop = 0;              ///< counted inwards from 1 beside the border of the block
    float angle = 0;                    ///< along the loop: 0 lateral, pi / 2 up [rad]
    bool left = true;                   ///< x >= 0
};

struct HeadLayout {
    std::vector<HeadVertex> vertices;
    std::vector<std::array<std::uint32_t, 4>> quads;  ///< counter-clockwise viewed from outside
    std::vector<std::uint32_t> mirror;                ///< mirror image per vertex; itself on x = 0
    int rows = kHeadRows;                             ///< to the ring where it ends
};

/// Number of loops of each kind, and the one at the edge of the opening.
inline constexpr int kEyeLoops = 14;
inline constexpr int kLidLoop = 9;  ///< outer edge of the lids' margin; the next is the inner edge
inline constexpr int kLidCreaseLoop = 6;  ///< where the upper lid folds
inline constexpr int kMouthLoops = 17;
inline constexpr int kLipLoop = 11;       ///< where the lips touch
inline constexpr int kLipBorderLoop = 7;  ///< where the red of the lips ends
inline constexpr int kNostrilLoops = 10;
inline constexpr int kNostrilRim = 5;  ///< further loops line the cavity
inline constexpr int kEarLoops = 28;

/// With `shoulders`, kShoulderRows rows follow the end of the neck; vertices above have the same
/// indices.
[[nodiscard]] const HeadLayout& head_layout(bool shoulders = false);

}  // namespace limn
