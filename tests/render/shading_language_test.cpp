#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>

// Where C++ and GLSL share a formula or a layout, both have the same values (shade.vector-ops,
// shade.stdlib).

namespace limn::test::shading_language_test {

TEST_CASE_FIXTURE(
    RenderTest, "vector_ops: matrices of the CPU transform points the same as on the GPU"
                    * technique("shade.vector-ops")) {
    const Vec3 position = {3, -1, 2};
    const Vec3 axis = glm::normalize(Vec3(1, -2, 0.5f));
    const Vec3 scale = {1, 2, 0.3f};
    const float angle = 0.8f;
    const Affine a = affine_from(position, glm::angleAxis(angle, axis), scale);
    const Mat4 m = to_mat4(a);
    const Vec3 p = {0.3f, 0.7f, -2};
    // Columns as a uniform has them, rows as an instance has them.
    const std::vector<Vec4> inputs = {m[0],     m[1],     m[2],     m[3],
                                      a.row[0], a.row[1], a.row[2], Vec4(p, 1)};
    const std::vector<Vec4> got = evaluate_shader(
        "",
        "if (i == 0u) { y = mat4(inputs[0], inputs[1], inputs[2], inputs[3]) * inputs[7]; }\n"
        "if (i == 1u) { y = vec4(dot(inputs[4], inputs[7]), dot(inputs[5], inputs[7]), "
        "dot(inputs[6], inputs[7]), 1.0); }\n",
        inputs);
    // Rodrigues' formula.
    const Vec3 r = scale * p;
    const Vec3 want = r * std::cos(angle) + (1 - std::cos(angle)) * glm::dot(axis, r) * axis
                      + std::sin(angle) * glm::cross(axis, r) + position;
    CHECK(glm::distance(got[0], Vec4(want, 1)) < 1e-5f);
    CHECK(glm::distance(got[1], Vec4(want, 1)) < 1e-5f);
    CHECK(glm::distance(transform_point(a, p), want) < 1e-5f);
}

TEST_CASE_FIXTURE(
    RenderTest, "stdlib: lit is the cosine and its power, both 0 below the horizon"
                    * technique("shade.stdlib")) {
    const std::vector<Vec4> inputs = {{0.5f, 0.8f, 2, 0},  {0.5f, 0.8f, 0, 0},  {0.9f, 1, 30, 0},
                                      {0.5f, 0, 2, 0},     {0.5f, -0.8f, 2, 0}, {0, 0.8f, 2, 0},
                                      {-0.5f, 0.8f, 2, 0}, {-0.5f, -0.8f, 2, 0}};
    const std::vector<Vec4> got =
        evaluate_shader("#include \"lib/brdf.glsl\"\n", "y = lit(x.x, x.y, x.z);", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        CAPTURE(i);
        const float n_l = inputs[i].x;
        const float n_h = inputs[i].y;
        const float specular = n_l > 0 && n_h > 0 ? std::pow(n_h, inputs[i].z) : 0.0f;
        CHECK(glm::distance(got[i], Vec4(1, std::max(n_l, 0.0f), specular, 1)) < 1e-5f);
    }
}

}  // namespace limn::test::shading_language_test
