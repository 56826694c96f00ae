#include "content/make/head/head_visemes.h"

// Techniques: face.viseme

namespace limn {

namespace {

constexpr float kVisemePerMm = 0.1f;  ///< centimeters

constexpr HeadViseme kVisemes[] = {
    {.name = "viseme_sil"},
    {.name = "viseme_pbm", .units = {{{"AU26", 0.05f}, {"AU8", 0.2f}, {"AU24", 0.4f}}}},
    {.name = "viseme_fv",
     .units = {{{"AU26", 0.1f}, {"AU32", 0.5f}, {"AU10", 0.25f}, {"AU20", 0.1f}}}},
    {.name = "viseme_th",
     .units = {{{"AU26", 0.25f}, {"AU25", 0.6f}, {"AU20", 0.1f}}},
     .tongue_tip = {0, 3, 9}},
    {.name = "viseme_td",
     .units = {{{"AU26", 0.2f}, {"AU25", 0.6f}, {"AU20", 0.1f}}},
     .tongue_tip = {0, 8, 3}},
    {.name = "viseme_kg",
     .units = {{{"AU26", 0.3f}, {"AU25", 0.6f}}},
     .tongue_tip = {0, -1, -3},
     .tongue_back = 8},
    {.name = "viseme_chjsh",
     .units = {{{"AU26", 0.15f}, {"AU22", 0.65f}, {"AU18", 0.2f}}},
     .tongue_tip = {0, 5, 0},
     .tongue_back = 3},
    {.name = "viseme_sz",
     .units = {{{"AU26", 0.08f}, {"AU25", 0.9f}, {"AU20", 0.3f}}},
     .tongue_tip = {0, 3, 2}},
    {.name = "viseme_nl",
     .units = {{{"AU26", 0.25f}, {"AU25", 0.6f}, {"AU20", 0.1f}}},
     .tongue_tip = {0, 9, 2}},
    {.name = "viseme_r",
     .units = {{{"AU26", 0.2f}, {"AU22", 0.35f}, {"AU18", 0.2f}}},
     .tongue_tip = {0, 7, -6},
     .tongue_back = 2},
    {.name = "viseme_a",
     .units = {{{"AU26", 1.0f}, {"AU25", 0.4f}, {"AU20", 0.1f}}},
     .tongue_tip = {0, -1, -2}},
    {.name = "viseme_e",
     .units = {{{"AU26", 0.5f}, {"AU25", 0.6f}, {"AU20", 0.45f}, {"AU12", 0.1f}}},
     .tongue_tip = {0, 1, 2},
     .tongue_back = 2},
    {.name = "viseme_i",
     .units = {{{"AU26", 0.25f}, {"AU25", 0.6f}, {"AU20", 0.6f}, {"AU12", 0.25f}}},
     .tongue_tip = {0, 2, 3},
     .tongue_back = 4},
    {.name = "viseme_o",
     .units = {{{"AU26", 0.55f}, {"AU22", 0.7f}, {"AU18", 0.3f}}},
     .tongue_tip = {0, 0, -4},
     .tongue_back = 3},
    {.name = "viseme_u",
     .units = {{{"AU26", 0.25f}, {"AU22", 0.4f}, {"AU18", 0.75f}}},
     .tongue_tip = {0, 1, -6},
     .tongue_back = 6},
};

}  // namespace

std::span<const HeadViseme> head_visemes() {
    return kVisemes;
}

Vec3 viseme_offset(const HeadViseme& viseme, const HeadPoint& point, const HeadShape& shape) {
    Vec3 offset = kVisemePerMm * square(point.tongue) * viseme.tongue_tip;
    offset.y += kVisemePerMm * viseme.tongue_back * 4 * point.tongue * (1 - point.tongue);
    for (const UnitWeight& part : viseme.units) {
        if (part.weight > 0) {
            offset += part.weight * action_offset(action_unit(part.unit), point, shape);
        }
    }
    return offset;
}

}  // namespace limn
