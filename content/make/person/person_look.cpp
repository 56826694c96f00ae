#include "content/make/person/person_look.h"

#include "ecs/base/rng.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

constexpr std::array<Vec3, 6> kSkinTones = {{
    {0.78f, 0.52f, 0.41f},
    {0.68f, 0.42f, 0.30f},
    {0.54f, 0.31f, 0.20f},
    {0.36f, 0.19f, 0.11f},
    {0.20f, 0.095f, 0.053f},
    {0.085f, 0.040f, 0.024f},
}};

constexpr std::array<Vec3, 6> kHairColors = {{
    {0.012f, 0.009f, 0.008f},  // black
    {0.030f, 0.016f, 0.009f},  // dark brown
    {0.075f, 0.036f, 0.017f},  // brown
    {0.16f, 0.075f, 0.03f},    // chestnut
    {0.38f, 0.24f, 0.11f},     // blond
    {0.24f, 0.07f, 0.022f},    // red
}};
constexpr Vec3 kGrayHair = {0.42f, 0.41f, 0.40f};

constexpr std::array<Vec3, 12> kShirtColors = {{
    {0.55f, 0.56f, 0.58f},    // white
    {0.035f, 0.037f, 0.04f},  // charcoal
    {0.03f, 0.06f, 0.15f},    // navy
    {0.16f, 0.29f, 0.5f},     // sky
    {0.28f, 0.04f, 0.045f},   // wine
    {0.09f, 0.17f, 0.10f},    // green
    {0.47f, 0.33f, 0.10f},    // mustard
    {0.38f, 0.17f, 0.14f},    // terracotta
    {0.2f, 0.2f, 0.21f},      // gray
    {0.36f, 0.31f, 0.23f},    // sand
    {0.23f, 0.13f, 0.28f},    // plum
    {0.10f, 0.26f, 0.28f},    // teal
}};

constexpr std::array<Vec3, 7> kTrousersColors = {{
    {0.035f, 0.055f, 0.11f},   // denim
    {0.09f, 0.14f, 0.25f},     // washed denim
    {0.022f, 0.023f, 0.026f},  // black
    {0.11f, 0.115f, 0.125f},   // gray
    {0.27f, 0.21f, 0.14f},     // khaki
    {0.075f, 0.05f, 0.035f},   // brown
    {0.03f, 0.035f, 0.055f},   // navy
}};

constexpr std::array<Vec3, 5> kShoeColors = {{
    {0.016f, 0.015f, 0.015f},
    {0.07f, 0.033f, 0.017f},
    {0.5f, 0.5f, 0.49f},
    {0.03f, 0.04f, 0.07f},
    {0.14f, 0.085f, 0.05f},
}};

constexpr std::array<Vec3, 4> kIrisColors = {{
    {0.055f, 0.026f, 0.012f},
    {0.11f, 0.055f, 0.02f},
    {0.09f, 0.15f, 0.22f},
    {0.09f, 0.12f, 0.06f},
}};

/// Heights of children in the middle between girls and boys, rounded (WHO, "Growth reference data
/// for 5-19 years", 2007) [m].
constexpr std::array<Vec2, 6> kHeightOfYears = {
    {{3, 0.955f}, {6, 1.155f}, {9, 1.33f}, {12, 1.50f}, {15, 1.65f}, {18, 1.70f}}};

float height_of_years(float years) {
    std::size_t i = 0;
    while (i + 2 < kHeightOfYears.size() && kHeightOfYears[i + 1].x < years) {
        ++i;
    }
    const Vec2& a = kHeightOfYears[i];
    const Vec2& b = kHeightOfYears[i + 1];
    return glm::mix(a.y, b.y, std::clamp((years - a.x) / (b.x - a.x), 0.0f, 1.0f));
}

class Chooser {
  public:
    explicit Chooser(int seed)
        : random_(static_cast<std::uint64_t>(seed), 0, name_hash("person"), 0) {}

    template <std::size_t count>
    Vec3 color(const std::array<Vec3, count>& colors, const Vec3& given) {
        const std::uint32_t index = random_.below(static_cast<std::uint32_t>(count));
        const float shade = random_.uniform(0.82f, 1.15f);
        return given == Vec3(0) ? glm::min(shade * colors[index], Vec3(1)) : given;
    }

    float number(float given, float open, float low, float high) {
        const float drawn = random_.uniform(low, high);
        return given == open ? drawn : given;
    }

    /// A number around the middle more often than at the ends.
    float middling(float given, float open, float low, float high) {
        const float first = random_.uniform();
        const float second = random_.uniform();
        return given == open ? glm::mix(low, high, 0.5f * (first + second)) : given;
    }

    bool chance(float probability) { return random_.uniform() < probability; }

    Random& random() { return random_; }

  private:
    Random random_;
};

/// Dark skin has dark hair and eyes, mostly.
template <std::size_t count>
std::uint32_t pigmented_index(Random& random, float melanin, const std::array<Vec3, count>&) {
    const float spread = melanin > 0.5f ? 1.6f : static_cast<float>(count);
    return std::min(
        static_cast<std::uint32_t>(random.uniform() * spread),
        static_cast<std::uint32_t>(count - 1));
}

PersonHair choose_hair(Random& random, bool woman, float age) {
    const float draw = random.uniform();
    if (woman) {
        return draw < 0.3f    ? PersonHair::Bob
               : draw < 0.65f ? PersonHair::Long
               : draw < 0.9f  ? PersonHair::Bun
                              : PersonHair::Short;
    }
    return draw < 0.12f + 0.2f * age ? PersonHair::Bald : PersonHair::Short;
}

PersonTop choose_top(float draw, PersonSleeves sleeves) {
    if (sleeves == PersonSleeves::Short) {
        return draw < 0.6f ? PersonTop::Tee : PersonTop::Shirt;
    }
    return draw < 0.45f ? PersonTop::Shirt : draw < 0.8f ? PersonTop::Jumper : PersonTop::Coat;
}

}  // namespace

Vec3 skin_tone(float melanin) {
    const float at = std::clamp(melanin, 0.0f, 1.0f) * (kSkinTones.size() - 1);
    const auto first = std::min(static_cast<std::size_t>(at), kSkinTones.size() - 2);
    return glm::mix(kSkinTones[first], kSkinTones[first + 1], at - static_cast<float>(first));
}

PersonLook choose_person(const PersonShape& shape) {
    PersonLook look;
    look.shape = shape;
    PersonShape& chosen = look.shape;
    Chooser chooser(shape.seed);
    const bool draws_woman = chooser.chance(0.5f);
    if (shape.sex == PersonSex::Any) {
        chosen.sex = draws_woman ? PersonSex::Woman : PersonSex::Man;
    }
    const bool woman = chosen.sex == PersonSex::Woman;
    const float features = chooser.number(2, 2, 0.55f, 0.95f);
    look.sex = woman ? -features : features;
    const float mean_height = woman ? 1.65f : 1.775f;  // Gordon et al. (1989), rounded
    chosen.height = chooser.middling(shape.height, 0, mean_height - 0.12f, mean_height + 0.12f);
    if (shape.years > 0) {
        const float vary = chosen.height / mean_height;
        chosen.height = shape.height > 0 ? shape.height : vary * height_of_years(shape.years);
        look.infant = std::pow(std::clamp((17 - shape.years) / 13, 0.0f, 1.1f), 0.8f);
        look.child = std::clamp((15 - shape.years) / 8, 0.0f, 1.0f);
    } else {
        look.child = 1 - glm::smoothstep(1.18f, 1.48f, chosen.height);
        look.infant = 0.8f * look.child;
    }
    chosen.build = chooser.middling(shape.build, -2, -0.9f, 0.9f);
    chosen.age = chooser.number(shape.age, -1, 0.0f, 0.85f);
    chosen.age *= shape.age < 0 ? 1 - look.child : 1.0f;
    chosen.melanin = chooser.number(shape.melanin, -1, 0.0f, 0.95f);
    look.skin_color = skin_tone(chosen.melanin);
    look.asymmetry = chooser.number(0, 0, 0.1f, 0.5f);
    Random& random = chooser.random();
    const std::uint32_t hair = pigmented_index(random, chosen.melanin, kHairColors);
    const std::uint32_t iris = pigmented_index(random, chosen.melanin, kIrisColors);
    look.iris_color = kIrisColors[iris];
    const float gray = glm::smoothstep(0.45f, 0.95f, chosen.age + random.uniform(-0.2f, 0.15f));
    if (shape.hair_color == Vec3(0)) {
        chosen.hair_color = glm::mix(kHairColors[hair], kGrayHair, gray);
    }
    const PersonHair style = choose_hair(random, woman, chosen.age);
    if (shape.hair == PersonHair::Any) {
        chosen.hair = style;
    }
    const float legs = random.uniform();
    if (shape.legs == PersonLegwear::Any) {
        chosen.legs = woman && legs < 0.35f   ? PersonLegwear::Skirt
                      : !woman && legs < 0.2f ? PersonLegwear::Shorts
                                              : PersonLegwear::Trousers;
    }
    const bool draws_short = chooser.chance(0.5f);
    if (shape.sleeves == PersonSleeves::Any) {
        chosen.sleeves = draws_short ? PersonSleeves::Short : PersonSleeves::Long;
    }
    chosen.shirt_color = chooser.color(kShirtColors, shape.shirt_color);
    chosen.trousers_color = chooser.color(kTrousersColors, shape.trousers_color);
    chosen.shoe_color = chooser.color(kShoeColors, shape.shoe_color);
    const bool draws_tucked = chooser.chance(0.3f);
    look.shirt_length = chooser.number(0, 0, 0.02f, 0.07f);
    look.folds = random.word();
    const float top = random.uniform();
    const bool dressed = random.uniform() < 0.4f;
    if (shape.top == PersonTop::Any) {
        chosen.top = choose_top(top, chosen.sleeves);
    }
    if (shape.legs == PersonLegwear::Any && chosen.legs == PersonLegwear::Skirt && dressed) {
        chosen.legs = PersonLegwear::Dress;
    }
    if (chosen.legs == PersonLegwear::Dress) {
        chosen.top = shape.top == PersonTop::Any ? PersonTop::Tee : chosen.top;
        chosen.trousers_color =
            shape.trousers_color == Vec3(0) ? chosen.shirt_color : shape.trousers_color;
    }
    const bool hangs = chosen.top == PersonTop::Jumper || chosen.top == PersonTop::Coat;
    look.tucked = chosen.legs == PersonLegwear::Dress
                  || (!hangs && (draws_tucked || chosen.legs == PersonLegwear::Skirt));
    if (chosen.top == PersonTop::Coat && shape.sleeves == PersonSleeves::Any) {
        chosen.sleeves = PersonSleeves::Long;
    }
    return look;
}

}  // namespace limn
