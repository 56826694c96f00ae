#include "content/bake/image_compare.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace limn::image_compare_test {
namespace {

ColorImage flat(int width, int height, const Vec3& color) {
    return {width, height, std::vector<Vec3>(static_cast<std::size_t>(width * height), color)};
}

ColorImage drawn(int width, int height, const std::function<Vec3(int, int)>& color) {
    ColorImage image = flat(width, height, Vec3(0));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.pixels[static_cast<std::size_t>(y * width + x)] = color(x, y);
        }
    }
    return image;
}

ColorImage noise(int width, int height, std::uint64_t seed) {
    Random random(seed, 0, name_hash("noise"), 0);
    return drawn(width, height, [&](int, int) {
        return Vec3(random.uniform(), random.uniform(), random.uniform());
    });
}

/// Soft blobs with a hard edge: something that looks like an image.
ColorImage scene(int width, int height, float shift) {
    return drawn(width, height, [&](int x, int y) {
        const float u = (static_cast<float>(x) + shift) / static_cast<float>(width);
        const float v = static_cast<float>(y) / static_cast<float>(height);
        const float blob = 0.5f + 0.5f * std::sin(9 * u) * std::cos(7 * v);
        return u > 0.5f ? Vec3(blob, 0.3f * blob, 0.1f) : Vec3(0.2f, 0.4f + 0.3f * blob, blob);
    });
}

double mean(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// ---- FLIP again, the slow way: double precision, two-dimensional kernels, as the paper has it
// -----------

using D3 = glm::dvec3;
using Grid = std::vector<double>;

D3 slow_xyz(const D3& rgb) {
    const D3 xyz = {
        (10135552 * rgb.x + 8788810 * rgb.y + 4435075 * rgb.z) / 24577794,
        (2613072 * rgb.x + 8788810 * rgb.y + 887015 * rgb.z) / 12288897,
        (1425312 * rgb.x + 8788810 * rgb.y + 70074185 * rgb.z) / 73733382};
    return xyz / D3(0.950428545, 1.0, 1.088900371);
}
D3 slow_rgb(const D3& relative) {
    const D3 xyz = relative * D3(0.950428545, 1.0, 1.088900371);
    return {
        3.241003275 * xyz.x - 1.537398934 * xyz.y - 0.498615861 * xyz.z,
        -0.969224334 * xyz.x + 1.875930071 * xyz.y + 0.041554224 * xyz.z,
        0.055639423 * xyz.x - 0.204011202 * xyz.y + 1.057148933 * xyz.z};
}
D3 slow_linear(const Vec3& srgb) {
    D3 out;
    for (int i = 0; i < 3; ++i) {
        const double c = static_cast<double>(srgb[i]);
        out[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    return out;
}
D3 slow_hunt(const D3& rgb) {
    const D3 xyz = slow_xyz(rgb);
    const auto f = [](double t) {
        return t > 216.0 / 24389.0 ? std::cbrt(t) : t * 841.0 / 108.0 + 4.0 / 29.0;
    };
    const double l = 116 * f(xyz.y) - 16;
    return {l, 0.01 * l * 500 * (f(xyz.x) - f(xyz.y)), 0.01 * l * 200 * (f(xyz.y) - f(xyz.z))};
}
double slow_hyab(const D3& a, const D3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

Grid slow_filter(
    const Grid& in, int w, int h, int radius, const std::function<double(int, int)>& weight) {
    Grid out(in.size(), 0.0);
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            for (int j = -radius; j <= radius; ++j) {
                for (int i = -radius; i <= radius; ++i) {
                    const int sx = std::min(std::max(x + i, 0), w - 1);
                    const int sy = std::min(std::max(y + j, 0), h - 1);
                    out[static_cast<std::size_t>(y * w + x)] +=
                        weight(i, j) * in[static_cast<std::size_t>(sy * w + sx)];
                }
            }
        }
    }
    return out;
}

struct SlowSide {
    std::vector<D3> lab;
    Grid edges;
    Grid points;
};

SlowSide slow_side(const ColorImage& image, double ppd) {
    const double pi = 3.14159265358979323846;
    const int w = image.width;
    const int h = image.height;
    Grid opponent[3];
    for (const Vec3& pixel : image.pixels) {
        const D3 xyz = slow_xyz(slow_linear(pixel));
        opponent[0].push_back(116 * xyz.y - 16);
        opponent[1].push_back(500 * (xyz.x - xyz.y));
        opponent[2].push_back(200 * (xyz.y - xyz.z));
    }
    const double a1[3] = {1, 1, 34.1};
    const double b1[3] = {0.0047, 0.0053, 0.04};
    const double a2[3] = {0, 0, 13.5};
    const double b2[3] = {1e-5, 1e-5, 0.025};
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    Grid filtered[3];
    for (int c = 0; c < 3; ++c) {
        const auto s = [&](int i, int j) {
            const double z = (i * i + j * j) / (ppd * ppd);
            return a1[c] * std::sqrt(pi / b1[c]) * std::exp(-pi * pi * z / b1[c])
                   + a2[c] * std::sqrt(pi / b2[c]) * std::exp(-pi * pi * z / b2[c]);
        };
        double sum = 0;
        for (int j = -radius; j <= radius; ++j) {
            for (int i = -radius; i <= radius; ++i) {
                sum += s(i, j);
            }
        }
        filtered[c] =
            slow_filter(opponent[c], w, h, radius, [&](int i, int j) { return s(i, j) / sum; });
    }
    SlowSide side;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const double y = (filtered[0][i] + 16) / 116;
        const D3 rgb = slow_rgb({y + filtered[1][i] / 500, y, y - filtered[2][i] / 200});
        side.lab.push_back(slow_hunt(glm::clamp(rgb, 0.0, 1.0)));
    }
    Grid achromatic = opponent[0];
    for (double& y : achromatic) {
        y = (y + 16) / 116;
    }
    const double sd = 0.5 * 0.082 * ppd;
    const int reach = static_cast<int>(std::ceil(3 * sd));
    for (const bool edge : {true, false}) {
        const auto raw = [&](int i, int j) {
            const double g = std::exp(-(i * i + j * j) / (2 * sd * sd));
            return edge ? -i * g : (i * i / (sd * sd) - 1) * g;
        };
        double positive = 0;
        double negative = 0;
        for (int j = -reach; j <= reach; ++j) {
            for (int i = -reach; i <= reach; ++i) {
                (raw(i, j) > 0 ? positive : negative) += raw(i, j);
            }
        }
        const auto weight = [&](int i, int j) {
            return raw(i, j) > 0 ? raw(i, j) / positive : -raw(i, j) / negative;
        };
        const Grid gx = slow_filter(achromatic, w, h, reach, weight);
        const Grid gy =
            slow_filter(achromatic, w, h, reach, [&](int i, int j) { return weight(j, i); });
        Grid& out = edge ? side.edges : side.points;
        for (std::size_t i = 0; i < gx.size(); ++i) {
            out.push_back(std::hypot(gx[i], gy[i]));
        }
    }
    return side;
}

Grid slow_flip(const ColorImage& a, const ColorImage& b, double ppd) {
    const SlowSide p = slow_side(a, ppd);
    const SlowSide q = slow_side(b, ppd);
    const double most = std::pow(slow_hyab(slow_hunt({0, 1, 0}), slow_hunt({0, 0, 1})), 0.7);
    Grid errors;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const double e = std::pow(slow_hyab(p.lab[i], q.lab[i]), 0.7);
        const double knee = 0.4 * most;
        const double color = e < knee ? 0.95 / knee * e : 0.95 + (e - knee) / (most - knee) * 0.05;
        const double feature =
            std::max(std::abs(p.edges[i] - q.edges[i]), std::abs(p.points[i] - q.points[i]));
        errors.push_back(std::pow(color, 1 - std::sqrt(feature / std::sqrt(2.0))));
    }
    return errors;
}

}  // namespace

TEST_CASE("image_compare: an image is equal to itself by every measure") {
    const ColorImage image = scene(40, 30, 0);
    CHECK(psnr(image, image) == std::numeric_limits<double>::infinity());
    CHECK(ssim(image, image) == test::near(1.0));
    CHECK(summarize_errors(flip_map(image, image)).mean == 0);
    CHECK(summarize_errors(flip_map(image, image)).p99 == 0);
    CHECK(relative_mse(image, image) == 0);
    CHECK(largest_difference(image, image).difference == 0);
    CHECK(color_correctness(image, image) == 1);
}

TEST_CASE("image_compare: PSNR, SSIM, FLIP and color correctness do not mind the order") {
    const ColorImage a = scene(40, 30, 0);
    const ColorImage b = scene(40, 30, 1.5f);
    CHECK(psnr(a, b) == psnr(b, a));
    CHECK(ssim(a, b) == test::near(ssim(b, a)).epsilon(1e-12));
    CHECK(flip_map(a, b) == flip_map(b, a));
    CHECK(color_correctness(a, b) == color_correctness(b, a));
}

TEST_CASE("psnr: a difference of a tenth everywhere is 20 dB, of one step in 255 is 48.13 dB") {
    CHECK(psnr(flat(8, 8, Vec3(0.4f)), flat(8, 8, Vec3(0.5f))) == test::near(20.0).epsilon(1e-5));
    CHECK(
        psnr(flat(8, 8, Vec3(0)), flat(8, 8, Vec3(1.0f / 255)))
        == test::near(48.1308).epsilon(1e-5));
    CHECK(
        psnr(flat(8, 8, Vec3(0)), flat(8, 8, Vec3(1, 0, 0)))
        == test::near(10 * std::log10(3.0)).epsilon(1e-6));
}

TEST_CASE("ssim: two flat images differ by their means alone") {
    const double a = 0.3;
    const double b = 0.7;
    const double expected = (2 * a * b + 1e-4) / (a * a + b * b + 1e-4);
    CHECK(
        ssim(flat(20, 20, Vec3(0.3f)), flat(20, 20, Vec3(0.7f)))
        == test::near(expected).epsilon(1e-3));
}

TEST_CASE("ssim: one window is the formula of the paper") {
    const ColorImage a = noise(11, 11, 1);
    const ColorImage b = noise(11, 11, 2);
    double weight_sum = 0;
    double moments[5] = {};
    for (int y = 0; y < 11; ++y) {
        for (int x = 0; x < 11; ++x) {
            const double w = std::exp(-((x - 5) * (x - 5) + (y - 5) * (y - 5)) / 4.5);
            const auto gray = [&](const ColorImage& image) {
                const Vec3 c = image.pixels[static_cast<std::size_t>(y * 11 + x)];
                return 0.2989 * static_cast<double>(c.x) + 0.587 * static_cast<double>(c.y)
                       + 0.114 * static_cast<double>(c.z);
            };
            const double terms[5] = {
                gray(a), gray(b), gray(a) * gray(a), gray(b) * gray(b), gray(a) * gray(b)};
            for (int i = 0; i < 5; ++i) {
                moments[i] += w * terms[i];
            }
            weight_sum += w;
        }
    }
    for (double& m : moments) {
        m /= weight_sum;
    }
    const auto [ma, mb, aa, bb, ab] =
        std::array<double, 5>{moments[0], moments[1], moments[2], moments[3], moments[4]};
    const double expected = (2 * ma * mb + 1e-4) * (2 * (ab - ma * mb) + 9e-4)
                            / ((ma * ma + mb * mb + 1e-4) * (aa - ma * ma + bb - mb * mb + 9e-4));
    CHECK(ssim(a, b) == test::near(expected).epsilon(1e-9));
}

TEST_CASE("ssim: it falls with noise, is negative for a negative, and takes tiny images") {
    const ColorImage a = scene(48, 48, 0);
    ColorImage some = a;
    ColorImage more = a;
    ColorImage negative = a;
    const ColorImage n = noise(48, 48, 5);
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        some.pixels[i] += 0.1f * (n.pixels[i] - 0.5f);
        more.pixels[i] += 0.4f * (n.pixels[i] - 0.5f);
    }
    CHECK(ssim(a, some) < 1);
    CHECK(ssim(a, more) < ssim(a, some));
    const ColorImage b = noise(48, 48, 6);
    ColorImage inverted = b;
    for (Vec3& pixel : inverted.pixels) {
        pixel = 1.0f - pixel;
    }
    CHECK(ssim(b, inverted) < 0);
    CHECK(ssim(flat(3, 2, Vec3(0.5f)), flat(3, 2, Vec3(0.5f))) == test::near(1.0));
}

TEST_CASE("flip: it agrees with the two-dimensional kernels of the paper in double precision") {
    for (const float ppd : {67.0206433f, 25.0f}) {
        const ColorImage a = scene(36, 28, 0);
        const ColorImage b = scene(36, 28, 2.5f);
        const ColorImage c = noise(36, 28, 3);
        for (const ColorImage* other : {&b, &c}) {
            const std::vector<float> fast = flip_map(a, *other, ppd);
            const Grid slow = slow_flip(a, *other, static_cast<double>(ppd));
            double worst = 0;
            for (std::size_t i = 0; i < fast.size(); ++i) {
                worst = std::max(worst, std::abs(static_cast<double>(fast[i]) - slow[i]));
            }
            CHECK(worst < 2e-3);  // where both images nearly agree, the root of a rounding error
            CHECK(
                mean(fast)
                == test::near(
                       std::accumulate(slow.begin(), slow.end(), 0.0)
                       / static_cast<double>(slow.size()))
                       .epsilon(1e-4));
        }
    }
}

TEST_CASE("flip: flat green against flat blue is the largest error there is") {
    const std::vector<float> errors = flip_map(flat(30, 30, {0, 1, 0}), flat(30, 30, {0, 0, 1}));
    for (const float error : errors) {
        CHECK(error == test::near(1.0f).epsilon(1e-4));
    }
}

TEST_CASE("flip: flat images differ by their colors alone, a little or beyond the knee") {
    // Black and white: HyAB 100, of at most 203.3 (green and blue), both to the 0.7th power.
    const double most = std::pow(slow_hyab(slow_hunt({0, 1, 0}), slow_hunt({0, 0, 1})), 0.7);
    CHECK(most == test::near(41.2761).epsilon(1e-5));  // the constant of the published evaluator
    const double white = std::pow(100.0, 0.7);
    const double expected = 0.95 + (white - 0.4 * most) / (0.6 * most) * 0.05;
    const std::vector<float> errors = flip_map(flat(20, 20, Vec3(0)), flat(20, 20, Vec3(1)));
    CHECK(errors[210] == test::near(expected).epsilon(1e-4));
    CHECK(mean(flip_map(flat(20, 20, Vec3(0.5f)), flat(20, 20, Vec3(0.505f)))) < 0.06);
}

TEST_CASE("flip: errors are 0 .. 1, also for colors beyond the display's") {
    ColorImage wild = noise(30, 30, 8);
    for (Vec3& pixel : wild.pixels) {
        pixel = 6.0f * pixel - 3.0f;
    }
    for (const float error : flip_map(wild, noise(30, 30, 9))) {
        CHECK(error >= 0);
        CHECK(error <= 1);
    }
}

TEST_CASE("flip: detail too fine for the eye hardly counts, and counts when one comes nearer") {
    const ColorImage checker =
        drawn(64, 64, [](int x, int y) { return Vec3((x + y) % 2 == 0 ? 0.45f : 0.55f); });
    const ColorImage gray = flat(64, 64, Vec3(0.5029f));
    const double far = mean(flip_map(gray, checker, 120));
    const double near = mean(flip_map(gray, checker, 15));
    CHECK(far < 0.5 * near);
}

TEST_CASE("flip: the same difference is worse where it adds an edge") {
    const ColorImage base = flat(64, 64, Vec3(0.5f));
    const ColorImage lighter = flat(64, 64, Vec3(0.6f));
    const ColorImage half = drawn(64, 64, [](int x, int) { return Vec3(x < 32 ? 0.5f : 0.6f); });
    const std::vector<float> edge = flip_map(base, half);
    CHECK(edge[32 * 64 + 33] > mean(flip_map(base, lighter)));
    CHECK(edge[32 * 64 + 2] < 1e-3f);
}

TEST_CASE("image_compare: a summary is the mean and what 99 of 100 do not exceed") {
    std::vector<float> errors(200, 0.0f);
    errors[7] = errors[50] = 1.0f;
    CHECK(summarize_errors(errors).mean == test::near(0.01));
    CHECK(summarize_errors(errors).p99 == 0);
    errors[51] = 0.5f;
    CHECK(summarize_errors(errors).p99 == test::near(0.5));
    CHECK(summarize_errors({}).mean == 0);
}

TEST_CASE("relative_mse: it is relative to the first image") {
    CHECK(relative_mse(flat(4, 4, Vec3(10)), flat(4, 4, Vec3(11)), 1e-9) == test::near(0.01));
    CHECK(relative_mse(flat(4, 4, Vec3(1000)), flat(4, 4, Vec3(1100)), 1e-9) == test::near(0.01));
    CHECK(relative_mse(flat(4, 4, Vec3(0)), flat(4, 4, Vec3(0.1f)), 0.01) == test::near(1.0));
    CHECK(
        relative_mse(flat(4, 4, Vec3(1)), flat(4, 4, Vec3(2)))
        > relative_mse(flat(4, 4, Vec3(2)), flat(4, 4, Vec3(1))));
}

TEST_CASE("image_compare: the largest difference names its pixel and channel, and sees a NaN") {
    const ColorImage a = scene(10, 8, 0);
    ColorImage b = a;
    b.pixels[3 * 10 + 7].y += 0.25f;
    b.pixels[5 * 10 + 1].z -= 0.125f;
    const LargestDifference found = largest_difference(a, b);
    CHECK(found.difference == test::near(0.25f));
    CHECK(found.pixel == IVec2(7, 3));
    CHECK(found.channel == 1);
    CHECK(
        largest_difference(flat(10, 8, Vec3(0)), flat(10, 8, Vec3(1))).pixel
        == IVec2(0, 0));  // the first
    b.pixels[9].x = std::numeric_limits<float>::quiet_NaN();
    CHECK(largest_difference(a, b).pixel == IVec2(9, 0));
    CHECK(std::isinf(largest_difference(a, b).difference));
    CHECK(largest_difference(b, b).difference == 0);
}

TEST_CASE(
    "color_correctness: 1 for equal, 0 for black and white, 1 - 51/765 for 51 steps in one channel"
    * technique("fakephong.metric-color")) {
    CHECK(color_correctness(flat(4, 4, Vec3(0)), flat(4, 4, Vec3(1))) == 0);
    const ColorImage a = flat(4, 4, {0.4f, 0.2f, 0.6f});
    CHECK(color_correctness(a, flat(4, 4, {0.6f, 0.2f, 0.6f})) == test::near(1.0 - 51.0 / 765.0));
}

TEST_CASE(
    "color_correctness: the background does not count, however large"
    * technique("fakephong.metric-color")) {
    const auto picture = [](int size, float shade) {
        return drawn(
            size, size, [&](int x, int y) { return x < 4 && y < 4 ? Vec3(shade) : Vec3(0.1f); });
    };
    const auto mask = [](int size) {
        std::vector<std::uint8_t> inside;
        for (int i = 0; i < size * size; ++i) {
            inside.push_back(i % size < 4 && i / size < 4 ? 1 : 0);
        }
        return inside;
    };
    const double small = color_correctness(picture(5, 0.5f), picture(5, 0.6f), mask(5));
    const double large = color_correctness(picture(50, 0.5f), picture(50, 0.6f), mask(50));
    CHECK(small == large);
    CHECK(small < 0.95);
    CHECK(color_correctness(picture(5, 0), picture(5, 1), std::vector<std::uint8_t>(25, 0)) == 1);
}

TEST_CASE(
    "enhanced_difference: 0 stays 0, 255 stays 255, one step shows as 146.5, and it can be undone"
    * technique("fakephong.metric-diffimage")) {
    const auto shown = [](float difference) {
        return enhanced_difference(flat(1, 1, Vec3(0)), flat(1, 1, Vec3(difference))).pixels[0].x;
    };
    CHECK(shown(0) == 0);
    CHECK(shown(1) == 1);
    CHECK(255.0f * shown(1.0f / 255) == test::near(146.5).epsilon(1e-3));
    float last = 0;
    for (int step = 1; step <= 255; ++step) {
        const float now = shown(static_cast<float>(step) / 255);
        CHECK(now > last);
        CHECK(std::pow(now, 10.0f) == test::near(step / 255.0).epsilon(1e-4));
        last = now;
    }
}

TEST_CASE(
    "scanline: white is 1, blue is a third, and the row is the one asked for"
    * technique("fakephong.metric-scanline")) {
    const ColorImage image = drawn(3, 2, [](int x, int y) {
        return y == 0 ? Vec3(0) : x == 1 ? Vec3(0, 0, 1) : Vec3(1);
    });
    CHECK(scanline(image, 1) == std::vector<float>{1.0f, 1.0f / 3.0f, 1.0f});
    CHECK(scanline(image, 0) == std::vector<float>{0, 0, 0});
}

TEST_CASE(
    "scanline: place and height of a highlight, and a kink, are found"
    * technique("fakephong.metric-scanline")) {
    std::vector<float> a(50);
    std::vector<float> b(50);
    for (std::size_t i = 0; i < 50; ++i) {
        const float x = static_cast<float>(i);
        a[i] = std::exp(-0.02f * (x - 20) * (x - 20));
        b[i] = 0.5f * std::max(0.0f, 1 - 0.1f * std::abs(x - 23));
    }
    const ScanlineComparison same = compare_scanlines(a, a);
    CHECK(same.peak_shift == 0);
    CHECK(same.peak_ratio == 1);
    CHECK(same.largest_difference == 0);
    const ScanlineComparison other = compare_scanlines(a, b);
    CHECK(other.peak_shift == 3);
    CHECK(other.peak_ratio == test::near(0.5));
    CHECK(other.roughness_b == test::near(0.1).epsilon(1e-3));
    CHECK(other.roughness_a < 0.05);
}

}  // namespace limn::image_compare_test
