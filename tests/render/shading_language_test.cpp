#include "bench/oracles/branch_cost.h"
#include "tests/render/shader_eval.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

// What the shading language promises and the references on the CPU rely on (shade.vector-ops,
// shade.stdlib, shade.control-flow).

namespace limn::test {
namespace {

/// What an expression of the vec4 `x` is, for its own input.
struct Case {
    std::string expression;
    Vec4 input;
    Vec4 want;
};

/// Every expression by the device, in one program; none has an input that the compiler knows.
std::vector<Vec4> values_of(const std::vector<Case>& cases, const std::string& includes = "") {
    std::string body = "switch (i) {\n";
    std::vector<Vec4> inputs;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        body += "case " + std::to_string(i) + "u: { " + cases[i].expression + " break; }\n";
        inputs.push_back(cases[i].input);
    }
    return evaluate_shader(includes, body + "}\n", inputs);
}

void check(const std::vector<Case>& cases, float tolerance, const std::string& includes = "") {
    const std::vector<Vec4> got = values_of(cases, includes);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        CAPTURE(cases[i].expression);
        for (int c = 0; c < 4; ++c) {
            CHECK(std::abs(got[i][c] - cases[i].want[c]) <= tolerance);
        }
    }
}

/// A function of one number, beside its double.
struct Function {
    std::string expression;
    std::function<double(double)> exact;
    double low;
    double high;
};

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "vector_ops: swizzles reorder, masks write what they name, * is apiece") {
    const Vec4 v = {1, 2, 3, 4};
    check(
        {{"y = x.wzyx;", v, {4, 3, 2, 1}},
         {"y = x.rrab;", v, {1, 1, 4, 3}},
         {"y = x; y.gb = vec2(1.0, 3.0);", {7, 4, 2, 5}, {7, 1, 3, 5}},
         {"y = x; y.wx = y.xw;", v, {4, 2, 3, 1}},
         {"y = x * x.yyyy + x / 2.0;", v, {2.5f, 5, 7.5f, 10}},
         {"y = vec4(cross(x.xyz, x.zyx), dot(x, x));", v, {-4, 8, -4, 30}},
         {"y.xy = vec2(1.0 + x.x * x.y, (1.0 + x.x) * x.y);", v, {3, 4, 0, 0}},
         {"y.xy = vec2(7 / 2, int(x.w) / 3);", v, {3, 1, 0, 0}}},  // integers are integers
        0);
}

TEST_CASE_FIXTURE(RenderTest, "vector_ops: matrices of the CPU move points as they do on the GPU") {
    const Affine shift = {{{1, 0, 0, 5}, {0, 1, 0, 6}, {0, 0, 1, 7}}};
    const Affine any = affine_from(
        {3, -1, 2}, glm::angleAxis(0.8f, glm::normalize(Vec3(1, -2, 0.5f))), {1, 2, 0.3f});
    for (const Affine& a : {shift, any}) {
        const Mat4 m = to_mat4(a);
        const Vec4 p = &a == &shift ? Vec4(0, 0, 0, 1) : Vec4(0.3f, 0.7f, -2, 1);
        // Rows as an instance has them, columns as a uniform has them.
        const std::vector<Vec4> inputs = {m[0], m[1], m[2],     m[3],     p,
                                          p,    p,    a.row[0], a.row[1], a.row[2]};
        const std::vector<Vec4> got = evaluate_shader(
            "",
            "mat4 m = mat4(inputs[0], inputs[1], inputs[2], inputs[3]);\n"
            "if (i == 4u) { y = m * x; }\n"
            "if (i == 5u) { y = x * m - transpose(m) * x; }\n"
            "if (i == 6u) { y = vec4(dot(inputs[7], x), dot(inputs[8], x), dot(inputs[9], x), "
            "1.0); }\n"
            "if (i == 0u) { y = (matrixCompMult(m, m) - m * m) * inputs[4]; }\n",
            inputs);
        const Vec4 want = {transform_point(a, Vec3(p)), 1};
        CHECK(glm::length(got[4] - want) < 1e-5f);
        CHECK(glm::length(got[6] - want) < 1e-5f);
        CHECK(glm::length(got[5]) < 1e-5f);
        CHECK(glm::length(got[0]) > 1);  // the product of matrices is not apiece
    }
    CHECK(transform_point(shift, {0, 0, 0}) == Vec3(5, 6, 7));
}

TEST_CASE_FIXTURE(
    RenderTest, "stdlib: rounding, ranges and geometry have the values of the table") {
    const float kPiF = std::numbers::pi_v<float>;
    check(
        {{"y = smoothstep(0.0, 1.0, x);", {0, 0.25f, 0.5f, 0.75f}, {0, 0.15625f, 0.5f, 0.84375f}},
         {"y.x = smoothstep(0.0, 1.0, x.x);", {1, 0, 0, 0}, {1, 0, 0, 0}},
         {"y.x = x.x - x.y * trunc(x.x / x.y);", {-5, 3, 0, 0}, {-2, 0, 0, 0}},  // fmod
         {"y.x = mod(x.x, x.y);", {-5, 3, 0, 0}, {1, 0, 0, 0}},
         {"y.x = fract(x.x);", {-0.25f, 0, 0, 0}, {0.75f, 0, 0, 0}},
         {"y.xy = step(x.xx, x.yz);", {2, 2, 1.9f, 0}, {1, 0, 0, 0}},
         {"int e; y.x = frexp(x.x, e); y.y = float(e);", {8, 0, 0, 0}, {0.5f, 4, 0, 0}},
         {"int e; y.x = frexp(x.x, e); y.y = float(e);", {0, 0, 0, 0}, {0, 0, 0, 0}},
         {"y.x = ldexp(x.x, int(x.y));", {0.75f, 5, 0, 0}, {24, 0, 0, 0}},
         {"float w; y.x = modf(x.x, w); y.y = w;", {-1.5f, 0, 0, 0}, {-0.5f, -1, 0, 0}},
         {"y.xyz = sign(x.xyz);", {-3, 0, 2, 0}, {-1, 0, 1, 0}},
         {"y = clamp(x, -1.0, 2.0);", {-3, -1, 0.5f, 7}, {-1, -1, 0.5f, 2}},
         {"y = vec4(ceil(x.x), floor(x.x), round(x.y), trunc(x.x));",
          {-1.2f, 2.7f, 0, 0},
          {-1, -2, 3, -1}},
         {"y.x = mix(x.x, x.y, x.z);", {2, 6, 0.25f, 0}, {3, 0, 0, 0}},
         {"y.xyz = reflect(x.xyz, vec3(0.0, 1.0, 0.0));", {1, -1, 0, 0}, {1, 1, 0, 0}},
         {"y.xyz = faceforward(x.xyz, vec3(0.0, 1.0, 0.0), x.xyz);", {1, 2, 3, 0}, {-1, -2, -3, 0}},
         {"y.xyz = refract(x.xyz, vec3(0.0, 1.0, 0.0), 1.5);", {1, 0, 0, 0}, {0, 0, 0, 0}},
         {"y.xy = vec2(length(x), distance(x, x.wzyx));",
          {1, 2, 2, 4},
          {5, std::sqrt(18.0f), 0, 0}},
         {"y.x = determinant(mat2(x));", {1, 2, 3, 4}, {-2, 0, 0, 0}},
         {"y.xy = vec2(any(greaterThan(x, vec4(3.0))), all(greaterThan(x, vec4(3.0))));",
          {1, 2, 3, 4},
          {1, 0, 0, 0}},
         {"y.xy = vec2(isnan(x.x / x.y), isinf(x.z / x.y));", {0, 0, 1, 0}, {1, 1, 0, 0}}},
        0);
    // The angles the table swaps: acos ends at 0 and pi, asin at +-pi/2.
    check(
        {{"y = vec4(acos(x.x), asin(x.x), acos(x.y), asin(x.y));",
          {-1, 1, 0, 0},
          {kPiF, -kPiF / 2, 0, kPiF / 2}},
         {"y = vec4(atan(x.x), atan(x.y, x.z), atan(-x.y, x.z), atan(x.w, x.w));",
          {1e9f, 0, -1, 0.5f},
          {kPiF / 2, kPiF, -kPiF, kPiF / 4}}},
        2e-3f);
    check(
        {{"y = lit(x.x, x.y, x.z);", {0.5f, 0.8f, 2, 0}, {1, 0.5f, 0.64f, 1}},
         {"y = lit(x.x, x.y, x.z);", {-0.5f, 0.8f, 2, 0}, {1, 0, 0, 1}}},
        1e-5f, "#include \"lib/brdf.glsl\"\n");
}

TEST_CASE_FIXTURE(RenderTest, "stdlib: functions of one number are those of mathematics to 1e-3") {
    const std::vector<Function> functions = {
        {"sin(x.x)", [](double x) { return std::sin(x); }, -10, 10},
        {"cos(x.x)", [](double x) { return std::cos(x); }, -10, 10},
        {"tan(x.x)", [](double x) { return std::tan(x); }, -1.4, 1.4},
        {"asin(x.x)", [](double x) { return std::asin(x); }, -1, 1},
        {"acos(x.x)", [](double x) { return std::acos(x); }, -1, 1},
        {"atan(x.x)", [](double x) { return std::atan(x); }, -30, 30},
        {"sinh(x.x)", [](double x) { return std::sinh(x); }, -3, 3},
        {"cosh(x.x)", [](double x) { return std::cosh(x); }, -3, 3},
        {"tanh(x.x)", [](double x) { return std::tanh(x); }, -5, 5},
        {"exp(x.x)", [](double x) { return std::exp(x); }, -8, 8},
        {"exp2(x.x)", [](double x) { return std::exp2(x); }, -8, 8},
        {"log(x.x)", [](double x) { return std::log(x); }, 0.01, 100},
        {"log2(x.x)", [](double x) { return std::log2(x); }, 0.01, 100},
        {"log(x.x) / log(10.0)", [](double x) { return std::log10(x); }, 0.01, 100},
        {"pow(x.x, 2.2)", [](double x) { return std::pow(x, 2.2); }, 0, 4},
        {"sqrt(x.x)", [](double x) { return std::sqrt(x); }, 0, 100},
        {"inversesqrt(x.x)", [](double x) { return 1 / std::sqrt(x); }, 0.01, 100},
        {"radians(x.x)", [](double x) { return x * std::numbers::pi / 180; }, -400, 400},
        {"degrees(x.x)", [](double x) { return x * 180 / std::numbers::pi; }, -7, 7},
        {"normalize(vec2(x.x, 2.0)).x", [](double x) { return x / std::hypot(x, 2); }, -9, 9}};
    std::vector<Vec4> inputs;
    constexpr std::size_t kSamples = 64;
    std::string body = "switch (i / 64u) {\n";
    for (std::size_t f = 0; f < functions.size(); ++f) {
        body += "case " + std::to_string(f) + "u: y.x = " + functions[f].expression + "; break;\n";
        for (std::size_t i = 0; i < kSamples; ++i) {
            const double share = static_cast<double>(i) / (kSamples - 1);
            inputs.emplace_back(
                functions[f].low + share * (functions[f].high - functions[f].low), 0, 0, 0);
        }
    }
    const std::vector<Vec4> got = evaluate_shader("", body + "}\n", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Function& f = functions[i / kSamples];
        const double want = f.exact(inputs[i].x);
        CAPTURE(f.expression);
        CAPTURE(inputs[i].x);
        CHECK(std::abs(got[i].x - want) <= 1e-3 * std::max(1.0, std::abs(want)));
    }
}

TEST_CASE("control_flow: a jump pays when what it saves is more than what it costs") {
    using oracle::branch_pays;
    CHECK_FALSE(branch_pays(8, 0.5, oracle::kIfElseCycles));  // saves 4 of 6
    CHECK(branch_pays(40, 0.5, oracle::kIfElseCycles));       // saves 20
    CHECK(branch_pays(40, 0.5, oracle::kIfCycles + 2 * oracle::kCallCycles));
    CHECK_FALSE(branch_pays(1000, 0, oracle::kIfCycles));  // never skipped
    CHECK_FALSE(branch_pays(4, 1, oracle::kIfCycles));     // as much as it costs
    CHECK(branch_pays(5, 1, oracle::kIfCycles));
    CHECK(branch_pays(6, 0.9, oracle::kLoopCycles));
}

TEST_CASE_FIXTURE(
    RenderTest, "control_flow: unrolled, looped, masked or jumped, the bits are the same") {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> any(-20, 20);
    std::vector<Vec4> inputs;
    for (int i = 0; i < 1000; ++i) {
        inputs.emplace_back(any(random), any(random), any(random), 5);
    }
    const std::string library = "#include \"lib/noise.glsl\"\n";
    const auto counted = evaluate_shader(library, "y.x = noise(x.xyz, 7u, 5);", inputs);
    const auto looped = evaluate_shader(library, "y.x = noise(x.xyz, 7u, int(x.w));", inputs);
    CHECK(counted == looped);
    const auto masked = evaluate_shader(
        library,
        "float a = noise(x.xy, 1u, 2); float b = 3.0 * noise(x.zx, 2u, 1); y.x = x.x > 0.0 ? a : "
        "b;",
        inputs);
    const auto jumped = evaluate_shader(
        library,
        "if (x.x > 0.0) { y.x = noise(x.xy, 1u, 2); } else { y.x = 3.0 * noise(x.zx, 2u, 1); }",
        inputs);
    CHECK(masked == jumped);
}

}  // namespace limn::test
