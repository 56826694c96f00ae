#include "render/lens/lens_ghosts.h"

#include <glm/mat2x2.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

// Techniques: engine.lens-flare

namespace limn {
namespace {

constexpr LensSurface kDoubleGauss[] = {
    {29.475, 3.76, 1.67, 25.2}, {84.83, 0.12, 1, 25.2},    {19.275, 4.025, 1.67, 23},
    {40.77, 3.275, 1.699, 23},  {12.75, 5.705, 1, 18},     {0, 4.5, 1, 17.1},
    {-14.495, 1.18, 1.603, 17}, {40.77, 6.065, 1.658, 20}, {-20.385, 0.19, 1, 20},
    {437.065, 3.22, 1.717, 20}, {-39.73, 0, 1, 20}};

constexpr double kMagnesiumFluoride = 1.38;
/// Wavelengths of the primaries of Rec. 709 [nm].
constexpr double kWavelengths[3] = {611, 549, 464};

double index_before(std::span<const LensSurface> lens, int surface) {
    return surface > 0 ? lens[surface - 1].index : 1;
}

/// A ray traced through a lens: its matrix so far, from the front surface.
class ParaxialPath {
  public:
    explicit ParaxialPath(std::span<const LensSurface> lens) : lens_(lens) {}

    void move(double distance) { apply({1, 0, distance, 1}); }  // columns
    void reflect(int surface, bool forward) { apply({1, 2 / radius(surface, forward), 0, 1}); }
    /// Through `surface`, or through the aperture, whose row it records.
    void pass(int surface, bool forward) {
        if (lens_[surface].radius == 0) {
            stops.push_back(row());
            return;
        }
        const double before = index_before(lens_, surface);
        const double behind = lens_[surface].index;
        const double ratio = forward ? before / behind : behind / before;
        apply({1, (ratio - 1) / radius(surface, forward), 0, ratio});
    }
    /// Forward through the surfaces first .. last - 1, and on to `last`.
    void pass_forward(int first, int last) {
        for (int i = first; i < last; ++i) {
            pass(i, true);
            move(lens_[i].thickness);
        }
    }
    /// Back from `first` to `last`, through the surfaces between them.
    void pass_back(int first, int last) {
        for (int i = first - 1; i >= last; --i) {
            move(lens_[i].thickness);
            if (i > last) {
                pass(i, false);
            }
        }
    }
    [[nodiscard]] ParaxialMap row() const { return {matrix[0][0], matrix[1][0]}; }

    glm::dmat2 matrix{1.0};
    std::vector<ParaxialMap> stops;

  private:
    void apply(const glm::dmat2& step) { matrix = step * matrix; }
    [[nodiscard]] double radius(int surface, bool forward) const {
        return forward ? lens_[surface].radius : -lens_[surface].radius;
    }

    std::span<const LensSurface> lens_;
};

double reflectance(
    std::span<const LensSurface> lens, int surface, const LensCoating& coating, double wavelength) {
    const double before = index_before(lens, surface);
    const double behind = lens[surface].index;
    const bool cemented = before != 1 && behind != 1;
    // Multiples of the golden ratio: evenly spread, and neighbors differ.
    const double turn = surface * std::numbers::phi;
    const double shift = coating.spread * (2 * (turn - std::floor(turn)) - 1);
    const double made_for =
        cemented || coating.wavelength <= 0 ? 0 : std::max(coating.wavelength + shift, 1.0);
    return coated_reflectance(before, kMagnesiumFluoride, behind, made_for, wavelength);
}

/// Light crosses the surfaces between the two twice more than on the direct path.
double ghost_strength(
    std::span<const LensSurface> lens, int near, int far, const LensCoating& coating,
    double wavelength) {
    double strength =
        reflectance(lens, near, coating, wavelength) * reflectance(lens, far, coating, wavelength);
    for (int i = near + 1; i < far; ++i) {
        if (lens[i].radius != 0) {
            const double passed = 1 - reflectance(lens, i, coating, wavelength);
            strength *= passed * passed;
        }
    }
    return strength;
}

}  // namespace

std::span<const LensSurface> double_gauss() {
    return kDoubleGauss;
}

LensFocus focus_of(std::span<const LensSurface> lens) {
    const int last = static_cast<int>(lens.size()) - 1;
    ParaxialPath path(lens);
    path.pass_forward(0, last);
    path.pass(last, true);
    const double power = -path.matrix[0][1];
    return {
        .focal_length = 1 / power,
        .image_distance = path.matrix[0][0] / power,
        .stop = path.stops.empty() ? ParaxialMap{} : path.stops.front()};
}

std::vector<LensGhost>
make_lens_ghosts(std::span<const LensSurface> lens, const LensCoating& coating) {
    const double image_distance = focus_of(lens).image_distance;
    const int last = static_cast<int>(lens.size()) - 1;
    std::vector<LensGhost> ghosts;
    for (int far = 1; far <= last; ++far) {
        for (int near = 0; near < far; ++near) {
            if (lens[near].radius == 0 || lens[far].radius == 0) {
                continue;
            }
            ParaxialPath path(lens);
            path.pass_forward(0, far);
            path.reflect(far, true);
            path.pass_back(far, near);
            path.reflect(near, false);
            path.move(lens[near].thickness);
            path.pass_forward(near + 1, last);
            path.pass(last, true);
            path.move(image_distance);

            LensGhost ghost = {.near = near, .far = far, .sensor = path.row()};
            ghost.passages = static_cast<int>(std::min<std::size_t>(path.stops.size(), 3));
            std::copy_n(path.stops.begin(), ghost.passages, ghost.stop);
            for (int i = 0; i < 3; ++i) {
                ghost.strength[i] =
                    static_cast<float>(ghost_strength(lens, near, far, coating, kWavelengths[i]));
            }
            ghosts.push_back(ghost);
        }
    }
    return ghosts;
}

double coated_reflectance(double n0, double n1, double n2, double made_for, double wavelength) {
    if (made_for <= 0) {
        return (n0 - n2) * (n0 - n2) / ((n0 + n2) * (n0 + n2));
    }
    const double outer = (n0 - n1) / (n0 + n1);
    const double inner = (n1 - n2) / (n1 + n2);
    // The layer is made_for / (4 n1) thick and passed twice.
    const double mixed = 2 * outer * inner * std::cos(std::numbers::pi * made_for / wavelength);
    return (outer * outer + inner * inner + mixed) / (1 + outer * outer * inner * inner + mixed);
}

}  // namespace limn
