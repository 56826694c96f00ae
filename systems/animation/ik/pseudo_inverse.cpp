#include "systems/animation/ik/pseudo_inverse.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cmath>
#include <vector>

// Techniques: char.ik-pinv

namespace limn {
namespace {

constexpr int kMaxSweeps = 12;
constexpr double kSingular = 1e-9;  ///< of the largest eigenvalue: 0

/// Eigenvalues (the diagonal of `a`) and eigenvectors (columns of `v`) of a symmetric matrix.
struct SymmetricEigen {
    std::size_t size = 0;
    std::vector<double> a;
    std::vector<double> v;

    void resize(std::size_t n) {
        size = n;
        a.assign(n * n, 0.0);
        v.assign(n * n, 0.0);
        for (std::size_t i = 0; i < n; ++i) {
            v[i * n + i] = 1;
        }
    }

    void rotate(std::size_t p, std::size_t q) {
        const double apq = a[p * size + q];
        const double theta = (a[q * size + q] - a[p * size + p]) / (2 * apq);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1 / std::sqrt(t * t + 1);
        const double s = t * c;
        for (std::size_t k = 0; k < size; ++k) {
            const double akp = a[k * size + p];
            const double akq = a[k * size + q];
            a[k * size + p] = c * akp - s * akq;
            a[k * size + q] = s * akp + c * akq;
        }
        for (std::size_t k = 0; k < size; ++k) {
            const double apk = a[p * size + k];
            const double aqk = a[q * size + k];
            a[p * size + k] = c * apk - s * aqk;
            a[q * size + k] = s * apk + c * aqk;
            const double vkp = v[k * size + p];
            const double vkq = v[k * size + q];
            v[k * size + p] = c * vkp - s * vkq;
            v[k * size + q] = s * vkp + c * vkq;
        }
    }

    void solve() {
        for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
            double off = 0;
            double all = 0;
            for (std::size_t i = 0; i < size; ++i) {
                for (std::size_t j = 0; j < size; ++j) {
                    const double square = a[i * size + j] * a[i * size + j];
                    all += square;
                    off += i == j ? 0 : square;
                }
            }
            if (!(off > 1e-30 * all)) {
                return;
            }
            for (std::size_t p = 0; p + 1 < size; ++p) {
                for (std::size_t q = p + 1; q < size; ++q) {
                    if (std::abs(a[p * size + q]) > 1e-300) {
                        rotate(p, q);
                    }
                }
            }
        }
    }
};

/// 1 / (s^2 + damping), by the square of the singular value.
double damped_reciprocal(double square, double damping, double largest) {
    if (!(square > kSingular * largest)) {
        square = std::max(square, 0.0);
        return damping > 0 && largest > 0 ? 1 / (square + damping * damping) : 0.0;
    }
    const double s = std::sqrt(square) / (2 * std::max(damping, 1e-300));
    const double added = s < 1 ? damping * damping * (1 - s * s) : 0.0;
    return 1 / (square + added);
}

}  // namespace

void find_pseudo_inverse(const IkMatrix& jacobian, float damping, IkMatrix& inverse) {
    thread_local SymmetricEigen eigen;  // reused
    thread_local std::vector<double> gram;
    const std::size_t rows = jacobian.rows;
    const std::size_t columns = jacobian.columns;
    inverse.resize(columns, rows);
    if (rows == 0 || columns == 0) {
        return;
    }
    const bool is_wide = rows <= columns;
    const std::size_t n = is_wide ? rows : columns;
    eigen.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            double sum = 0;
            for (std::size_t k = 0; k < (is_wide ? columns : rows); ++k) {
                sum += is_wide ? double(jacobian.at(i, k)) * double(jacobian.at(j, k))
                               : double(jacobian.at(k, i)) * double(jacobian.at(k, j));
            }
            eigen.a[i * n + j] = sum;
        }
    }
    eigen.solve();
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
        largest = std::max(largest, eigen.a[i * n + i]);
    }
    // gram = V diag(1 / s^2) V^T, the inverse of the smaller product.
    gram.assign(n * n, 0.0);
    for (std::size_t e = 0; e < n; ++e) {
        const double factor =
            damped_reciprocal(eigen.a[e * n + e], std::max(damping, 0.0f), largest);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                gram[i * n + j] += factor * eigen.v[i * n + e] * eigen.v[j * n + e];
            }
        }
    }
    for (std::size_t column = 0; column < columns; ++column) {
        for (std::size_t row = 0; row < rows; ++row) {
            double sum = 0;
            for (std::size_t k = 0; k < n; ++k) {
                sum += is_wide ? double(jacobian.at(k, column)) * gram[k * n + row]
                               : gram[column * n + k] * double(jacobian.at(row, k));
            }
            inverse.at(column, row) = static_cast<float>(sum);
        }
    }
}

void project_to_null_space(
    const IkMatrix& jacobian, const IkMatrix& inverse, std::span<float> step) {
    LIMN_CHECK(jacobian.columns == step.size() && inverse.rows == step.size());
    thread_local std::vector<float> moved;
    moved.resize(jacobian.rows);
    multiply(jacobian, step, moved);
    for (std::size_t i = 0; i < step.size(); ++i) {
        float back = 0;
        for (std::size_t row = 0; row < moved.size(); ++row) {
            back += inverse.at(i, row) * moved[row];
        }
        step[i] -= back;
    }
}

}  // namespace limn
