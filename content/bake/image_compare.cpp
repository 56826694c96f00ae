#include "content/bake/image_compare.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

// Techniques: fakephong.metric-color, fakephong.metric-diffimage, fakephong.metric-scanline

namespace limn {

namespace {

void check_pair(const ColorImage& a, const ColorImage& b) {
    LIMN_CHECK(a.width == b.width && a.height == b.height && a.width > 0 && a.height > 0);
    const auto count = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
    LIMN_CHECK(a.pixels.size() == count && b.pixels.size() == count);
}

/// One channel.
struct Plane {
    int width;
    int height;
    std::vector<float> values;
};

Plane make_plane(const ColorImage& image, const std::function<float(const Vec3&)>& value) {
    Plane plane{image.width, image.height, std::vector<float>(image.pixels.size())};
    std::transform(image.pixels.begin(), image.pixels.end(), plane.values.begin(), value);
    return plane;
}

/// Weights at -radius .. radius.
using Kernel = std::vector<float>;

/// Convolution with column(y) row(x), edges clamped. Kernels are already flipped.
Plane convolve(const Plane& in, const Kernel& row, const Kernel& column) {
    const auto pass = [](const Plane& from, const Kernel& kernel, bool along_x) {
        Plane to{from.width, from.height, std::vector<float>(from.values.size())};
        const int radius = static_cast<int>(kernel.size() / 2);
        const int end = along_x ? from.width : from.height;
        const std::ptrdiff_t stride = along_x ? 1 : from.width;
        parallel_for(
            static_cast<std::size_t>(from.height), 16, [&](std::size_t first, std::size_t last) {
                for (std::size_t y = first; y < last; ++y) {
                    for (int x = 0; x < from.width; ++x) {
                        const int at = along_x ? x : static_cast<int>(y);
                        const float* line =
                            along_x ? &from.values[y * static_cast<std::size_t>(from.width)]
                                    : &from.values[static_cast<std::size_t>(x)];
                        float sum = 0;
                        for (int k = -radius; k <= radius; ++k) {
                            sum += kernel[static_cast<std::size_t>(k + radius)]
                                   * line[std::clamp(at + k, 0, end - 1) * stride];
                        }
                        to.values
                            [y * static_cast<std::size_t>(from.width)
                             + static_cast<std::size_t>(x)] = sum;
                    }
                }
            });
        return to;
    };
    return pass(pass(in, row, true), column, false);
}

Kernel gaussian(int radius, double exponent_scale) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x) {
        kernel.push_back(static_cast<float>(std::exp(-exponent_scale * x * x)));
    }
    return kernel;
}

double sum_of(const Kernel& kernel) {
    return std::accumulate(kernel.begin(), kernel.end(), 0.0);
}

Kernel scaled_image(const Kernel& kernel, double factor) {
    Kernel out = kernel;
    for (float& weight : out) {
        weight = static_cast<float>(static_cast<double>(weight) * factor);
    }
    return out;
}

double luma(const Vec3& c) {
    return 0.2989 * static_cast<double>(c.x) + 0.5870 * static_cast<double>(c.y)
           + 0.1140 * static_cast<double>(c.z);
}

int to_step(float x) {
    return static_cast<int>(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f);
}

}  // namespace

double psnr(const ColorImage& a, const ColorImage& b) {
    check_pair(a, b);
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 difference = glm::dvec3(a.pixels[i]) - glm::dvec3(b.pixels[i]);
        sum += glm::dot(difference, difference);
    }
    const double mse = sum / (3.0 * static_cast<double>(a.pixels.size()));
    return mse > 0 ? -10.0 * std::log10(mse) : std::numeric_limits<double>::infinity();
}

double ssim(const ColorImage& a, const ColorImage& b) {
    check_pair(a, b);
    constexpr int kRadius = 5;
    constexpr double kC1 = 0.01 * 0.01;
    constexpr double kC2 = 0.03 * 0.03;
    double weights[2 * kRadius + 1];
    double total = 0;
    for (int k = -kRadius; k <= kRadius; ++k) {
        weights[k + kRadius] = std::exp(-k * k / (2 * 1.5 * 1.5));
        total += weights[k + kRadius];
    }

    // Horizontal pass first, of all five moments at once.
    struct Moments {
        double a, b, aa, bb, ab;
    };
    const int w = a.width;
    const int h = a.height;
    const auto at = [w](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(w)
               + static_cast<std::size_t>(x);
    };
    std::vector<Moments> rows(a.pixels.size());
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            Moments m = {};
            for (int k = -kRadius; k <= kRadius; ++k) {
                const std::size_t pixel = at(std::clamp(x + k, 0, w - 1), y);
                const double weight = weights[k + kRadius] / total;
                const double la = luma(a.pixels[pixel]);
                const double lb = luma(b.pixels[pixel]);
                m.a += weight * la;
                m.b += weight * lb;
                m.aa += weight * la * la;
                m.bb += weight * lb * lb;
                m.ab += weight * la * lb;
            }
            rows[at(x, y)] = m;
        }
    }

    // Only windows inside the image count, unless there is none.
    const int x_margin = w > 2 * kRadius ? kRadius : 0;
    const int y_margin = h > 2 * kRadius ? kRadius : 0;
    double sum = 0;
    for (int y = y_margin; y < h - y_margin; ++y) {
        for (int x = x_margin; x < w - x_margin; ++x) {
            Moments m = {};
            for (int k = -kRadius; k <= kRadius; ++k) {
                const Moments& row = rows[at(x, std::clamp(y + k, 0, h - 1))];
                const double weight = weights[k + kRadius] / total;
                m.a += weight * row.a;
                m.b += weight * row.b;
                m.aa += weight * row.aa;
                m.bb += weight * row.bb;
                m.ab += weight * row.ab;
            }
            const double variance_a = m.aa - m.a * m.a;
            const double variance_b = m.bb - m.b * m.b;
            const double covariance = m.ab - m.a * m.b;
            sum += (2 * m.a * m.b + kC1) * (2 * covariance + kC2)
                   / ((m.a * m.a + m.b * m.b + kC1) * (variance_a + variance_b + kC2));
        }
    }
    return sum / (static_cast<double>(w - 2 * x_margin) * static_cast<double>(h - 2 * y_margin));
}

// ---- FLIP --------------------------------------------------------------------------------------

namespace {

/// XYZ of linear RGB under D65, over the white point; rows.
constexpr double kRgbToXyz[3][3] = {
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}};

/// XYZ / white, so that white is (1, 1, 1).
Mat3 rgb_to_relative_xyz() {
    glm::dmat3 m;
    for (int row = 0; row < 3; ++row) {
        const double white = kRgbToXyz[row][0] + kRgbToXyz[row][1] + kRgbToXyz[row][2];
        for (int column = 0; column < 3; ++column) {
            m[column][row] = kRgbToXyz[row][column] / white;
        }
    }
    return Mat3(m);
}

Vec3 decode_srgb(const Vec3& c) {
    const auto decode = [](float x) {
        return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
    };
    return {decode(c.x), decode(c.y), decode(c.z)};
}

/// (Y, Cx, Cz): L*a*b* without its cube root, so that it can be filtered.
Vec3 to_opponent(const Vec3& xyz) {
    return {116.0f * xyz.y - 16.0f, 500.0f * (xyz.x - xyz.y), 200.0f * (xyz.y - xyz.z)};
}
Vec3 from_opponent(const Vec3& c) {
    const float y = (c.x + 16.0f) / 116.0f;
    return {y + c.y / 500.0f, y, y - c.z / 200.0f};
}

/// L*a*b* with chroma scaled by lightness (Hunt effect).
Vec3 to_hunt_lab(const Vec3& xyz) {
    const auto root = [](float t) {
        constexpr float kDelta = 6.0f / 29.0f;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t)
                                            : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
    };
    const float l = 116.0f * root(xyz.y) - 16.0f;
    const float a = 500.0f * (root(xyz.x) - root(xyz.y));
    const float b = 200.0f * (root(xyz.y) - root(xyz.z));
    return {l, 0.01f * l * a, 0.01f * l * b};
}

float hyab(const Vec3& a, const Vec3& b) {
    const Vec3 difference = a - b;
    return std::abs(difference.x) + glm::length(Vec2(difference.y, difference.z));
}

/// Contrast sensitivity of the eye in one opponent channel, as a sum of two Gaussians a sqrt(pi /
/// b) exp(-(pi x)^2 / b), x in degrees.
struct Sensitivity {
    double a[2];
    double b[2];
};
constexpr Sensitivity kSensitivities[3] = {
    {{1, 0}, {0.0047, 1e-5}},       // achromatic
    {{1, 0}, {0.0053, 1e-5}},       // red-green
    {{34.1, 13.5}, {0.04, 0.025}},  // blue-yellow
};
constexpr double kWidest = 0.04;
constexpr double kPiD = 3.14159265358979323846;

Plane filter_contrast(
    const Plane& plane, const Sensitivity& sensitivity, double pixels_per_degree) {
    const int radius = static_cast<int>(
        std::ceil(3.0 * std::sqrt(kWidest / (2.0 * kPiD * kPiD)) * pixels_per_degree));
    Kernel kernels[2];
    double shares[2];
    double total = 0;
    for (int i = 0; i < 2; ++i) {
        kernels[i] = gaussian(
            radius, kPiD * kPiD / (sensitivity.b[i] * pixels_per_degree * pixels_per_degree));
        shares[i] = sensitivity.a[i] * std::sqrt(kPiD / sensitivity.b[i]);
        total += shares[i] * sum_of(kernels[i]) * sum_of(kernels[i]);
    }
    Plane out = convolve(plane, scaled_image(kernels[0], shares[0] / total), kernels[0]);
    if (sensitivity.a[1] != 0) {
        const Plane second =
            convolve(plane, scaled_image(kernels[1], shares[1] / total), kernels[1]);
        for (std::size_t i = 0; i < out.values.size(); ++i) {
            out.values[i] += second.values[i];
        }
    }
    return out;
}

/// Inputs of the color pipeline, and the achromatic channel for the feature pipeline.
struct FlipSide {
    std::vector<Vec3> lab;
    Plane achromatic;  ///< 0 .. 1
};

FlipSide prepare_side(const ColorImage& image, double pixels_per_degree) {
    const Mat3 to_xyz = rgb_to_relative_xyz();
    const Mat3 to_rgb = glm::inverse(to_xyz);
    ColorImage opponent{image.width, image.height, std::vector<Vec3>(image.pixels.size())};
    std::transform(
        image.pixels.begin(), image.pixels.end(), opponent.pixels.begin(), [&](const Vec3& c) {
            return to_opponent(to_xyz * decode_srgb(glm::clamp(c, 0.0f, 1.0f)));
        });

    Plane planes[3];
    for (int i = 0; i < 3; ++i) {
        planes[i] = filter_contrast(
            make_plane(opponent, [i](const Vec3& c) { return c[i]; }), kSensitivities[i],
            pixels_per_degree);
    }
    FlipSide side;
    side.lab.resize(image.pixels.size());
    for (std::size_t i = 0; i < side.lab.size(); ++i) {
        const Vec3 filtered = {planes[0].values[i], planes[1].values[i], planes[2].values[i]};
        const Vec3 rgb = glm::clamp(to_rgb * from_opponent(filtered), 0.0f, 1.0f);
        side.lab[i] = to_hunt_lab(to_xyz * rgb);
    }
    side.achromatic = make_plane(opponent, [](const Vec3& c) { return (c.x + 16.0f) / 116.0f; });
    return side;
}

/// First (edge) or second (point) derivative of a Gaussian as wide as the eye's; positive weights
/// sum to 1, negative ones to -1.
Kernel feature_kernel(bool edge, double sd, int radius) {
    std::vector<double> weights;
    double positive = 0;
    double negative = 0;
    for (int x = -radius; x <= radius; ++x) {
        const double bell = std::exp(-x * x / (2 * sd * sd));
        const double weight = edge ? -x * bell : (x * x / (sd * sd) - 1) * bell;
        weights.push_back(weight);
        (weight > 0 ? positive : negative) += weight;
    }
    Kernel kernel;
    for (const double weight : weights) {
        kernel.push_back(static_cast<float>(weight > 0 ? weight / positive : -weight / negative));
    }
    return kernel;
}

/// Strength of edges or points at every pixel, 0 .. sqrt(2).
std::vector<float> find_features(const Plane& achromatic, bool edge, double pixels_per_degree) {
    const double sd = 0.5 * 0.082 * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * sd));
    const Kernel feature = feature_kernel(edge, sd, radius);
    const Kernel bell = gaussian(radius, 1.0 / (2 * sd * sd));
    const Kernel across = scaled_image(bell, 1.0 / sum_of(bell));
    const Plane x = convolve(achromatic, feature, across);
    const Plane y = convolve(achromatic, across, feature);
    std::vector<float> strength(x.values.size());
    for (std::size_t i = 0; i < strength.size(); ++i) {
        strength[i] = glm::length(Vec2(x.values[i], y.values[i]));
    }
    return strength;
}

}  // namespace

std::vector<float> flip_map(const ColorImage& a, const ColorImage& b, float pixels_per_degree) {
    check_pair(a, b);
    LIMN_CHECK(pixels_per_degree > 0);
    constexpr float kColorExponent = 0.7f;
    constexpr float kFeatureExponent = 0.5f;
    constexpr float kKnee = 0.4f;         // of the largest color error ...
    constexpr float kKneeTarget = 0.95f;  // ... is mapped to this
    const double ppd = static_cast<double>(pixels_per_degree);
    const FlipSide sides[2] = {prepare_side(a, ppd), prepare_side(b, ppd)};
    std::vector<float> edges[2];
    std::vector<float> points[2];
    for (int i = 0; i < 2; ++i) {
        edges[i] = find_features(sides[i].achromatic, true, ppd);
        points[i] = find_features(sides[i].achromatic, false, ppd);
    }

    // Green and blue are the two colors of sRGB that are farthest apart.
    const Mat3 to_xyz = rgb_to_relative_xyz();
    const float most =
        std::pow(hyab(to_hunt_lab(to_xyz[1]), to_hunt_lab(to_xyz[2])), kColorExponent);
    const float knee = kKnee * most;
    std::vector<float> errors(a.pixels.size());
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const float power = std::pow(hyab(sides[0].lab[i], sides[1].lab[i]), kColorExponent);
        const float color =
            power < knee ? power * kKneeTarget / knee
                         : kKneeTarget + (power - knee) / (most - knee) * (1.0f - kKneeTarget);
        const float feature_difference =
            std::max(std::abs(edges[0][i] - edges[1][i]), std::abs(points[0][i] - points[1][i]));
        const float feature = std::pow(feature_difference / std::sqrt(2.0f), kFeatureExponent);
        errors[i] =
            std::clamp(std::pow(std::min(color, 1.0f), 1.0f - std::min(feature, 1.0f)), 0.0f, 1.0f);
    }
    return errors;
}

ErrorSummary summarize_errors(std::span<const float> errors) {
    if (errors.empty()) {
        return {};
    }
    std::vector<float> sorted(errors.begin(), errors.end());
    const auto rank =
        static_cast<std::ptrdiff_t>(std::ceil(0.99 * static_cast<double>(sorted.size()))) - 1;
    std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
    return {
        std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size()),
        static_cast<double>(sorted[static_cast<std::size_t>(rank)])};
}

double relative_mse(const ColorImage& a, const ColorImage& b, double epsilon) {
    check_pair(a, b);
    LIMN_CHECK(epsilon > 0);
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 reference = a.pixels[i];
        const glm::dvec3 difference = glm::dvec3(b.pixels[i]) - reference;
        const glm::dvec3 relative = difference * difference / (reference * reference + epsilon);
        sum += relative.x + relative.y + relative.z;
    }
    return sum / (3.0 * static_cast<double>(a.pixels.size()));
}

LargestDifference largest_difference(const ColorImage& a, const ColorImage& b) {
    check_pair(a, b);
    LargestDifference largest;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width)
                           + static_cast<std::size_t>(x);
            for (int channel = 0; channel < 3; ++channel) {
                const float p = a.pixels[i][channel];
                const float q = b.pixels[i][channel];
                float difference = p == q ? 0.0f : std::abs(q - p);  // equal infinities are equal
                if (std::isnan(difference)) {
                    difference = std::isnan(p) && std::isnan(q) ? 0.0f : INFINITY;
                }
                if (difference > largest.difference) {
                    largest = {difference, {x, y}, channel};
                }
            }
        }
    }
    return largest;
}

// ---- fake Phong --------------------------------------------------------------------------------

double
color_correctness(const ColorImage& a, const ColorImage& b, std::span<const std::uint8_t> mask) {
    check_pair(a, b);
    LIMN_CHECK(mask.empty() || mask.size() == a.pixels.size());
    std::int64_t sum = 0;
    std::int64_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (!mask.empty() && mask[i] == 0) {
            continue;
        }
        ++count;
        for (int channel = 0; channel < 3; ++channel) {
            sum += std::abs(to_step(a.pixels[i][channel]) - to_step(b.pixels[i][channel]));
        }
    }
    return count == 0 ? 1.0 : 1.0 - static_cast<double>(sum) / (765.0 * static_cast<double>(count));
}

ColorImage enhanced_difference(const ColorImage& a, const ColorImage& b, float exponent) {
    check_pair(a, b);
    ColorImage out{a.width, a.height, std::vector<Vec3>(a.pixels.size())};
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const Vec3 difference = glm::min(glm::abs(b.pixels[i] - a.pixels[i]), Vec3(1));
        out.pixels[i] = glm::pow(difference, Vec3(exponent));
    }
    return out;
}

std::vector<float> scanline(const ColorImage& image, int row) {
    LIMN_CHECK(row >= 0 && row < image.height);
    std::vector<float> line;
    for (int x = 0; x < image.width; ++x) {
        const Vec3& c = image.pixels
                            [static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width)
                             + static_cast<std::size_t>(x)];
        line.push_back((c.x + c.y + c.z) / 3.0f);
    }
    return line;
}

ScanlineComparison compare_scanlines(std::span<const float> a, std::span<const float> b) {
    LIMN_CHECK(a.size() == b.size() && !a.empty());
    const auto roughness = [](std::span<const float> line) {
        double most = 0;
        for (std::size_t i = 1; i + 1 < line.size(); ++i) {
            const double bend = static_cast<double>(line[i - 1])
                                - 2.0 * static_cast<double>(line[i])
                                + static_cast<double>(line[i + 1]);
            most = std::max(most, std::abs(bend));
        }
        return most;
    };
    const auto peak_a = std::max_element(a.begin(), a.end());
    const auto peak_b = std::max_element(b.begin(), b.end());
    ScanlineComparison result;
    result.peak_shift = static_cast<int>((peak_b - b.begin()) - (peak_a - a.begin()));
    result.peak_ratio =
        *peak_a == *peak_b ? 1.0 : static_cast<double>(*peak_b) / static_cast<double>(*peak_a);
    result.roughness_a = roughness(a);
    result.roughness_b = roughness(b);
    for (std::size_t i = 0; i < a.size(); ++i) {
        result.largest_difference = std::max(
            result.largest_difference,
            std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    }
    return result;
}

}  // namespace limn
