#pragma once

#include "content/make/models/creature.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// A dressed person: a low-polygon human for crowds, facing +z, standing on y = 0, arms 45 degrees
// below the horizontal. It wears the head of head.h with fewer triangles, hands with five fingers,
// and clothes that are closed shells around the body: what is sewn onto them (collars, plackets,
// pockets, belt loops) are small shells of their own, which levels of detail leave out. Below a
// height of 1.5 m, or 17 years, the proportions are those of a child (person_growth.h). The
// skeleton (person_skeleton.h) has 60 joints with the names of a person (humanoid.h), with
// anatomical limits. Every person is another one: what is left open is chosen by `seed`.
//
// Each part is a mesh with its own material; "all" is everything in one. Vertex colors are the
// colors of skin, cloth and hair, for white materials; of "all", their alpha is the part, for the
// Dress of a material. Texture coordinates are meters, except for
// the face, whose chart is that of the head; v runs along strands of hair from roots to tips.
// Morph targets follow elbows, knees, hips and shoulders that bend (bend_shapes.h), but not in
// levels of detail; those of the face (person_face.h) are also in near ones. Clips: "idle", and for
// looking at the body "arms_up", "sit", "squat", "fist" and "palms_up"; for a morph_player "talk",
// "blink" and "smile".

enum class PersonPart : std::uint8_t { All, Skin, Eyes, Hair, Shirt, Trousers, Shoes };
enum class PersonSex : std::uint8_t { Any, Woman, Man };
enum class PersonHair : std::uint8_t { Any, Short, Bob, Long, Bun, Bald };
enum class PersonTop : std::uint8_t { Any, Tee, Shirt, Jumper, Coat };
enum class PersonLegwear : std::uint8_t { Any, Trousers, Shorts, Skirt, Dress };
enum class PersonSleeves : std::uint8_t { Any, Short, Long };

struct PersonShape {
    PersonPart part = PersonPart::All;
    int seed = 1;
    PersonSex sex = PersonSex::Any;
    float height = 0.0f;
    float build = -2.0f;
    float age = -1.0f;
    float years = 0.0f;
    float melanin = -1.0f;
    PersonHair hair = PersonHair::Any;
    PersonTop top = PersonTop::Any;
    PersonLegwear legs = PersonLegwear::Any;
    PersonSleeves sleeves = PersonSleeves::Any;
    Vec3 hair_color = {0, 0, 0};
    Vec3 shirt_color = {0, 0, 0};
    Vec3 trousers_color = {0, 0, 0};
    Vec3 shoe_color = {0, 0, 0};
    int head_triangles = 2700;
    int triangles = 0;
};

LIMN_FIELDS(PersonShape) {
    LIMN_FIELD(
        part, .doc = "part of the person", .values = "all skin eyes hair shirt trousers shoes");
    LIMN_FIELD(seed, "chooses what the other parameters leave open", "", 0, 1000000000);
    LIMN_FIELD(sex, .doc = "proportions; any: by the seed", .values = "any woman man");
    LIMN_FIELD(height, "from the soles to the crown; 0: by sex and seed", "m", 0, 10);
    LIMN_FIELD(build, "-1: lean, 1: heavy; -2: by the seed", "", -2, 1);
    LIMN_FIELD(age, "0: twenty years, 1: seventy; -1: by the seed", "", -1, 1);
    LIMN_FIELD(
        years, "of a child, whose height and proportions follow; 0: grown up, or as high as asked",
        "", 0, 18);
    LIMN_FIELD(melanin, "color of the skin, 0: fair, 1: dark; -1: by the seed", "", -1, 1);
    LIMN_FIELD(hair, .doc = "hair style", .values = "any short bob long bun bald");
    LIMN_FIELD(top, .doc = "worn on the trunk", .values = "any tee shirt jumper coat");
    LIMN_FIELD(legs, .doc = "worn on the legs", .values = "any trousers shorts skirt dress");
    LIMN_FIELD(sleeves, .doc = "of the shirt", .values = "any short long");
    LIMN_FIELD(
        hair_color, .doc = "linear; black: by seed and age", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(shirt_color, .doc = "linear; black: by the seed", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(
        trousers_color,
        .doc = "linear, of shorts or a skirt as well; black: by the seed, of a dress: the shirt's",
        .min = 0, .max = 1, .color = true);
    LIMN_FIELD(shoe_color, .doc = "linear; black: by the seed", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(head_triangles, "of face and neck, approximately", "", 500, 24000);
    LIMN_FIELD(
        triangles, "of the part, approximately, for levels of detail; 0 = all", "", 0, 1000000);
}

/// With at most 4 joints per vertex.
[[nodiscard]] MeshData make_person(const PersonShape& shape);

/// The same skeleton for all parts and seeds, except for proportions.
[[nodiscard]] MeshRig make_person_rig(const PersonShape& shape);

}  // namespace limn
