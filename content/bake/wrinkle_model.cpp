#include "content/bake/wrinkle_model.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

// Techniques: face.wrinkle-model

namespace limn {

namespace {

constexpr int kMaxTerms = 19;
constexpr float kMinRange = 1e-3f;  ///< smaller ranges of strain are scaled by it

using Terms = std::array<float, kMaxTerms>;

/// x, y, z; then their products in the order of lib/wrinkle_model.glsl.
int find_terms(int degree, const Vec3& x, Terms& terms) {
    std::size_t n = 0;
    for (int i = 0; i < 3; ++i) {
        terms[n++] = x[i];
    }
    for (int i = 0; degree >= 2 && i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            terms[n++] = x[i] * x[j];
        }
    }
    for (int i = 0; degree >= 3 && i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            for (int k = j; k < 3; ++k) {
                terms[n++] = x[i] * x[j] * x[k];
            }
        }
    }
    return static_cast<int>(n);
}

Vec3 scaled_strain(const Vec3& strain, const Vec3& min_strain, const Vec3& max_strain) {
    return glm::clamp(strain, min_strain, max_strain)
           / glm::max(glm::max(-min_strain, max_strain), Vec3(kMinRange));
}

/// Solves (A + ridge I) c = b for two right sides by Cholesky's method; `a` is symmetric.
class NormalEquations {
  public:
    explicit NormalEquations(int terms) : terms_(static_cast<std::size_t>(terms)) {}

    void add(const Terms& x, const Vec2& y) {
        for (std::size_t i = 0; i < terms_; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                a_[i][j] += double{x[i]} * double{x[j]};
            }
            b_[i][0] += double{x[i]} * double{y.x};
            b_[i][1] += double{x[i]} * double{y.y};
        }
    }
    void solve(double ridge, Vec2* coefficients) {
        for (std::size_t i = 0; i < terms_; ++i) {
            a_[i][i] += ridge;
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = a_[i][j];
                for (std::size_t k = 0; k < j; ++k) {
                    sum -= a_[i][k] * a_[j][k];
                }
                a_[i][j] = i == j ? std::sqrt(std::max(sum, 1e-30)) : sum / a_[j][j];
            }
        }
        for (std::size_t side = 0; side < 2; ++side) {
            for (std::size_t i = 0; i < terms_; ++i) {
                for (std::size_t k = 0; k < i; ++k) {
                    b_[i][side] -= a_[i][k] * b_[k][side];
                }
                b_[i][side] /= a_[i][i];
            }
            for (std::size_t i = terms_; i-- > 0;) {
                for (std::size_t k = i + 1; k < terms_; ++k) {
                    b_[i][side] -= a_[k][i] * b_[k][side];
                }
                b_[i][side] /= a_[i][i];
            }
        }
        for (std::size_t i = 0; i < terms_; ++i) {
            coefficients[i] = Vec2(static_cast<float>(b_[i][0]), static_cast<float>(b_[i][1]));
        }
    }

  private:
    std::size_t terms_;
    double a_[kMaxTerms][kMaxTerms] = {};
    double b_[kMaxTerms][2] = {};
};

bool is_finite_at(std::span<const WrinklePose> poses, std::size_t texel) {
    return std::ranges::all_of(poses, [texel](const WrinklePose& pose) {
        const Vec2& slope = pose.slopes[texel];
        return is_finite(pose.strain[texel]) && std::isfinite(slope.x) && std::isfinite(slope.y);
    });
}

void fit_texel(
    std::span<const WrinklePose> poses, float ridge, std::size_t texel, WrinkleModel& model) {
    if (!is_finite_at(poses, texel)) {
        return;
    }
    Vec3& min_strain = model.min_strain[texel];
    Vec3& max_strain = model.max_strain[texel];
    bool smooth = true;
    for (const WrinklePose& pose : poses) {
        min_strain = glm::min(min_strain, pose.strain[texel]);
        max_strain = glm::max(max_strain, pose.strain[texel]);
        smooth = smooth && pose.slopes[texel] == Vec2(0);
    }
    if (smooth) {
        return;
    }
    const int count = wrinkle_terms(model.degree);
    NormalEquations equations(count);
    for (const WrinklePose& pose : poses) {
        Terms terms;
        find_terms(model.degree, scaled_strain(pose.strain[texel], min_strain, max_strain), terms);
        equations.add(terms, pose.slopes[texel]);
    }
    equations.solve(double{ridge}, &model.coefficients[texel * static_cast<std::size_t>(count)]);
}

}  // namespace

int wrinkle_terms(int degree) {
    LIMN_CHECK(degree >= 1 && degree <= 3);
    return degree == 1 ? 3 : degree == 2 ? 9 : kMaxTerms;
}

WrinkleModel fit_wrinkle_model(
    int size, std::span<const WrinklePose> poses, const WrinkleModelOptions& options) {
    const auto texels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    for (const WrinklePose& pose : poses) {
        LIMN_CHECK(pose.strain.size() == texels && pose.slopes.size() == texels);
    }
    const auto terms = static_cast<std::size_t>(wrinkle_terms(options.degree));
    WrinkleModel model = {
        .size = size,
        .degree = options.degree,
        .min_strain = std::vector<Vec3>(texels, Vec3(0)),
        .max_strain = std::vector<Vec3>(texels, Vec3(0)),
        .coefficients = std::vector<Vec2>(texels * terms, Vec2(0))};
    parallel_for(texels, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t texel = begin; texel < end; ++texel) {
            fit_texel(poses, options.ridge, texel, model);
        }
    });
    return model;
}

Vec2 modeled_slope(const WrinkleModel& model, std::size_t texel, const Vec3& strain) {
    Terms terms;
    const int count = find_terms(
        model.degree, scaled_strain(strain, model.min_strain[texel], model.max_strain[texel]),
        terms);
    Vec2 slope = {0, 0};
    for (int i = 0; i < count; ++i) {
        slope += terms[static_cast<std::size_t>(i)]
                 * model.coefficients
                       [texel * static_cast<std::size_t>(count) + static_cast<std::size_t>(i)];
    }
    return slope;
}

ImageData pack_wrinkle_model(const WrinkleModel& model) {
    const auto terms = static_cast<std::size_t>(wrinkle_terms(model.degree));
    const std::size_t tiles = 2 + (terms + 1) / 2;
    const std::size_t texels = model.min_strain.size();
    ImageData image;
    image.name = "wrinkle model";
    image.width = model.size;
    image.height = model.size * static_cast<int>(tiles);
    image.format = PixelFormat::Rgba16F;
    image.pixels.resize(texels * tiles * sizeof(std::uint64_t));
    const auto put = [&](std::size_t tile, std::size_t texel, const Vec4& value) {
        const std::uint64_t packed = glm::packHalf4x16(value);
        std::memcpy(&image.pixels[(tile * texels + texel) * sizeof packed], &packed, sizeof packed);
    };
    for (std::size_t i = 0; i < texels; ++i) {
        const Vec3& low = model.min_strain[i];
        const Vec3& high = model.max_strain[i];
        put(0, i, {low.x, high.x, low.y, high.y});
        put(1, i, {low.z, high.z, 0, 0});
        const Vec2* const c = &model.coefficients[i * terms];
        for (std::size_t k = 0; k < terms; k += 2) {
            const Vec2 second = k + 1 < terms ? c[k + 1] : Vec2(0);
            put(2 + k / 2, i, Vec4(c[k], second));
        }
    }
    return image;
}

}  // namespace limn
