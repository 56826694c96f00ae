#include "systems/animation/ik/pseudo_inverse.h"
#include "tests/near.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::pseudo_inverse_test {

using namespace limn::test;

namespace {

IkMatrix jacobian_of(const RandomChain& chain, const JointState& state) {
    IkMatrix jacobian;
    find_jacobian(chain.tree, find_frames(chain.tree, state), chain.tip, 0, jacobian);
    return jacobian;
}

/// a * b, in double precision.
std::vector<double> product(const IkMatrix& a, const IkMatrix& b) {
    std::vector<double> c(a.rows * b.columns, 0.0);
    for (std::size_t i = 0; i < a.rows; ++i) {
        for (std::size_t j = 0; j < b.columns; ++j) {
            for (std::size_t k = 0; k < a.columns; ++k) {
                c[i * b.columns + j] += double(a.at(i, k)) * double(b.at(k, j));
            }
        }
    }
    return c;
}

float length_of(const std::vector<float>& v) {
    float sum = 0;
    for (const float x : v) {
        sum += x * x;
    }
    return std::sqrt(sum);
}

/// J of `rows` random independent rows.
IkMatrix random_matrix(Random& random, std::size_t rows, std::size_t columns) {
    IkMatrix matrix;
    matrix.resize(rows, columns);
    for (float& value : matrix.values) {
        value = random.uniform(-1.0f, 1.0f);
    }
    return matrix;
}

/// Matrix I - J+ J, column by column.
IkMatrix projector(const IkMatrix& jacobian, const IkMatrix& inverse) {
    IkMatrix p;
    p.resize(jacobian.columns, jacobian.columns);
    for (std::size_t column = 0; column < jacobian.columns; ++column) {
        std::vector<float> unit(jacobian.columns, 0.0f);
        unit[column] = 1;
        project_to_null_space(jacobian, inverse, unit);
        for (std::size_t row = 0; row < jacobian.columns; ++row) {
            p.at(row, column) = unit[row];
        }
    }
    return p;
}

}  // namespace

TEST_CASE(
    "Jacobian: of random chains with hinges and slides, it agrees with central differences in "
    "double precision"
    * technique("char.ik-jacobian")) {
    Random random(1, 0, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const RandomChain chain = make_random_chain(random, 2 + i % 9, i % 2 == 0);
        const JointState state = random_state(random, chain.tree);
        const IkMatrix jacobian = jacobian_of(chain, state);
        for (std::size_t column = 0; column < jacobian.columns; ++column) {
            const oracle::Vec3d expected =
                oracle::ik_column(chain.joints, to_double(state), chain.end, column);
            for (std::size_t row = 0; row < 3; ++row) {
                CHECK(std::abs(double(jacobian.at(row, column)) - expected[row]) < 1e-5);
            }
        }
    }
}

TEST_CASE(
    "Jacobian: of free joints and of orientation, it predicts small steps; axes beside the "
    "effector's ancestors have columns of 0"
    * technique("char.ik-jacobian")) {
    Random random(2, 0, 0, 0);
    JointTree tree = make_free_chain(3);
    add_joint(tree, 1, {1, 0, 0});  // a branch
    add_hinge(tree, {0, 0, 1});
    add_joint(tree, 2, {0, 1, 0});
    add_hinge(tree, {1, 0, 0});
    const Effector tip = {4, {0.2f, 0.3f, 0}};
    for (int i = 0; i < 20; ++i) {
        const JointState state = random_state(random, tree);
        const JointFrames frames = find_frames(tree, state);
        IkMatrix jacobian;
        find_jacobian(tree, frames, tip, 0.5f, jacobian);
        REQUIRE(jacobian.rows == 6);
        std::vector<float> step(tree.axes.size());
        for (float& value : step) {
            value = random.uniform(-1e-3f, 1e-3f);
        }
        std::vector<float> moved(6);
        multiply(jacobian, step, moved);
        JointState after = state;
        advance(tree, step, after);
        const JointFrames there = find_frames(tree, after);
        const Vec3 position = effector_position(there, tip) - effector_position(frames, tip);
        CHECK(glm::distance(position, Vec3(moved[0], moved[1], moved[2])) < 2e-5f);
        const Quat turn = there.rotations[4] * glm::conjugate(frames.rotations[4]);
        const Vec3 rotation = 2.0f * log_rotation(turn.w < 0 ? -turn : turn);
        CHECK(glm::distance(0.5f * rotation, Vec3(moved[3], moved[4], moved[5])) < 2e-5f);
        for (std::size_t row = 0; row < 6; ++row) {
            CHECK(jacobian.at(row, 9) == 0);  // the branch
        }
    }
}

TEST_CASE(
    "pseudo-inverse: J J+ = I, and P = I - J+ J is a symmetric projector of trace n - m into the "
    "null space of J"
    * technique("char.ik-pinv")) {
    Random random(3, 0, 0, 0);
    for (int i = 0; i < 40; ++i) {
        const std::size_t rows = i % 2 == 0 ? 3 : 6;
        const std::size_t n = rows + 1 + static_cast<std::size_t>(i) % 5;
        const IkMatrix jacobian = random_matrix(random, rows, n);
        IkMatrix inverse;
        find_pseudo_inverse(jacobian, 0, inverse);
        REQUIRE(inverse.rows == n);
        REQUIRE(inverse.columns == rows);
        double size = 1;
        for (const float value : inverse.values) {
            size = std::max(size, double(std::abs(value)));
        }
        const std::vector<double> one = product(jacobian, inverse);
        for (std::size_t row = 0; row < rows; ++row) {
            for (std::size_t column = 0; column < rows; ++column) {
                CHECK(std::abs(one[row * rows + column] - (row == column ? 1 : 0)) < 1e-6 * size);
            }
        }
        const IkMatrix p = projector(jacobian, inverse);
        const std::vector<double> twice = product(p, p);
        const std::vector<double> moved = product(jacobian, p);
        double trace = 0;
        for (std::size_t row = 0; row < n; ++row) {
            trace += double(p.at(row, row));
            for (std::size_t column = 0; column < n; ++column) {
                CHECK(std::abs(p.at(row, column) - p.at(column, row)) < 2e-6 * size);
                CHECK(std::abs(twice[row * n + column] - double(p.at(row, column))) < 4e-6 * size);
            }
        }
        CHECK(trace == near(double(n - rows)).epsilon(1e-5));
        for (const double value : moved) {
            CHECK(std::abs(value) < 4e-6 * size);
        }
    }
}

TEST_CASE(
    "pseudo-inverse: three links in the plane have one freedom left" * technique("char.ik-pinv")) {
    const JointTree tree = make_planar_chain({1, 1, 1});
    JointState state = zero_state(tree);
    state.values = {0.3f, 0.8f, -0.5f};
    IkMatrix jacobian;
    find_jacobian(tree, find_frames(tree, state), planar_tip(tree, 1), 0, jacobian);
    IkMatrix inverse;
    find_pseudo_inverse(jacobian, 0, inverse);  // the row of z is 0
    const IkMatrix p = projector(jacobian, inverse);
    CHECK(p.at(0, 0) + p.at(1, 1) + p.at(2, 2) == near(1).epsilon(1e-5));
    // J+ dX moves as asked in the plane.
    const std::vector<float> move = {0.01f, -0.02f, 0};
    std::vector<float> step(3);
    std::vector<float> moved(3);
    multiply(inverse, move, step);
    multiply(jacobian, step, moved);
    CHECK(std::abs(moved[0] - move[0]) < 1e-7f);
    CHECK(std::abs(moved[1] - move[1]) < 1e-7f);
}

TEST_CASE("pseudo-inverse: J+ dX is the shortest of all solutions" * technique("char.ik-pinv")) {
    Random random(4, 0, 0, 0);
    const IkMatrix jacobian = random_matrix(random, 3, 7);
    IkMatrix inverse;
    find_pseudo_inverse(jacobian, 0, inverse);
    std::vector<float> shortest(7);
    multiply(inverse, std::vector<float>{0.3f, -0.4f, 0.5f}, shortest);
    for (int i = 0; i < 50; ++i) {
        std::vector<float> other(7);
        for (float& value : other) {
            value = random.uniform(-1.0f, 1.0f);
        }
        project_to_null_space(jacobian, inverse, other);
        for (std::size_t k = 0; k < 7; ++k) {
            other[k] += shortest[k];
        }
        CHECK(length_of(other) > length_of(shortest));
    }
}

TEST_CASE(
    "pseudo-inverse: a null-space step moves the effector only to second order"
    * technique("char.ik-pinv")) {
    Random random(5, 0, 0, 0);
    const RandomChain chain = make_random_chain(random, 7);
    const JointState state = random_state(random, chain.tree);
    const IkMatrix jacobian = jacobian_of(chain, state);
    IkMatrix inverse;
    find_pseudo_inverse(jacobian, 0, inverse);
    std::vector<float> z(7);
    for (float& value : z) {
        value = random.uniform(-1.0f, 1.0f);
    }
    project_to_null_space(jacobian, inverse, z);
    REQUIRE(length_of(z) > 0.1f);
    const auto moved_by = [&](float size) {
        std::vector<float> step = z;
        for (float& value : step) {
            value *= size / length_of(z);
        }
        JointState after = state;
        advance(chain.tree, step, after);
        return glm::distance(
            tip_of(chain.tree, after, chain.tip), tip_of(chain.tree, state, chain.tip));
    };
    CHECK(moved_by(0.1f) / moved_by(0.05f) == near(4).epsilon(0.15));
    CHECK(moved_by(0.05f) < 0.02f);
}

TEST_CASE(
    "pseudo-inverse: more rows than columns solve in the least-squares sense; rank loss and "
    "empty matrices are finite"
    * technique("char.ik-pinv")) {
    Random random(6, 0, 0, 0);
    const IkMatrix tall = random_matrix(random, 6, 3);
    IkMatrix inverse;
    find_pseudo_inverse(tall, 0, inverse);
    const std::vector<double> one = product(inverse, tall);
    for (std::size_t i = 0; i < 9; ++i) {
        CHECK(std::abs(one[i] - (i % 4 == 0 ? 1 : 0)) < 3e-6);
    }
    IkMatrix flat;
    flat.resize(3, 4);
    find_pseudo_inverse(flat, 0, inverse);
    CHECK(std::all_of(
        inverse.values.begin(), inverse.values.end(), [](float value) { return value == 0; }));
    for (std::size_t column = 0; column < 4; ++column) {
        flat.at(0, column) = 1;
        flat.at(1, column) = 1;
    }
    for (const float damping : {0.0f, 0.05f}) {
        find_pseudo_inverse(flat, damping, inverse);
        for (const float value : inverse.values) {
            CHECK(std::isfinite(value));
            CHECK(std::abs(value) < 1);
        }
    }
    find_pseudo_inverse(IkMatrix{}, 0.1f, inverse);
    CHECK(inverse.values.empty());
}

TEST_CASE(
    "pseudo-inverse: with damping no step is longer than the move / lambda, however singular, and "
    "far from singular it is exact"
    * technique("char.ik-pinv")) {
    const JointTree tree = make_planar_chain({1, 1});
    constexpr float kLambda = 0.05f;
    IkMatrix jacobian;
    IkMatrix inverse;
    IkMatrix undamped;
    float longest = 0;
    float longest_undamped = 0;
    for (int i = 0; i <= 200; ++i) {
        JointState state = zero_state(tree);
        state.values = {0.2f, 0.005f * static_cast<float>(i)};
        find_jacobian(tree, find_frames(tree, state), planar_tip(tree, 1), 0, jacobian);
        find_pseudo_inverse(jacobian, kLambda, inverse);
        find_pseudo_inverse(jacobian, 0, undamped);
        const std::vector<float> inward = {-0.01f * std::cos(0.2f), -0.01f * std::sin(0.2f), 0};
        std::vector<float> step(2);
        multiply(inverse, inward, step);
        longest = std::max(longest, length_of(step));
        if (i == 200) {
            std::vector<float> exact(2);
            multiply(undamped, inward, exact);
            CHECK(std::abs(step[0] - exact[0]) + std::abs(step[1] - exact[1]) < 1e-6f);
        }
        if (i > 0) {
            multiply(undamped, inward, step);
            longest_undamped = std::max(longest_undamped, length_of(step));
        }
    }
    CHECK(longest <= 0.01f / kLambda);
    CHECK(longest_undamped > 2 * longest);
}

}  // namespace limn::pseudo_inverse_test
