// Maps of highlights by direction in the camera's axes, z toward the camera: the definition ENVIRONMENT_LAYOUT is a
// HighlightLayout. Cells of the cube and of the paraboloids have a gutter of a texel, so that filters do not mix them.
// Techniques: fakephong.envmap, fakephong.envmap-bake

const float kMapSide = 256.0;  // kHighlightMapSize [px]

#if ENVIRONMENT_LAYOUT == 2
const vec2 kCells = vec2(3.0, 2.0);    // axis, sign
const float kCellSide = 85.0;          // [px]
#elif ENVIRONMENT_LAYOUT == 3
const vec2 kCells = vec2(2.0, 1.0);
const float kCellSide = 128.0;
#endif

#if ENVIRONMENT_LAYOUT >= 2
const float kInnerHalf = 0.5 * kCellSide - 1.0;

// Position of `at`, -1 .. 1 in a cell, in the whole map.
vec2 from_cell(vec2 at, vec2 cell) {
    return 2.0 * ((cell + 0.5) * kCellSide + kInnerHalf * at) / kMapSide - 1.0;
}
// The opposite; `at` leaves -1 .. 1 in the gutter.
void to_cell(vec2 place, out vec2 at, out vec2 cell) {
    vec2 texel = 0.5 * (place + 1.0) * kMapSide;
    cell = min(floor(texel / kCellSide), kCells - 1.0);
    at = (texel - (cell + 0.5) * kCellSide) / kInnerHalf;
}
#endif

// Position in the map, -1 .. 1, of a direction of any length.
vec2 map_place(vec3 w) {
    w = dot(w, w) > 1e-10 ? w : vec3(0.0, 0.0, 1.0);  // between opposite directions
#if ENVIRONMENT_LAYOUT == 1
    vec3 unit = normalize(w);
    return vec2(atan(unit.x, unit.z), 2.0 * asin(clamp(unit.y, -1.0, 1.0))) * 0.318309886;
#elif ENVIRONMENT_LAYOUT == 2
    vec3 size = abs(w);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    vec3 turned = axis == 0 ? w.yzx : axis == 1 ? w.zxy : w;  // the axis last
    return from_cell(turned.xy / abs(turned.z), vec2(float(axis), turned.z < 0.0 ? 1.0 : 0.0));
#elif ENVIRONMENT_LAYOUT == 3
    vec3 unit = normalize(w);
    return from_cell(unit.xy / (1.0 + abs(unit.z)), vec2(unit.z < 0.0 ? 1.0 : 0.0, 0.0));
#else
    float m2 = w.x * w.x + w.y * w.y + (w.z + 1.0) * (w.z + 1.0);
    return m2 > 1e-10 ? w.xy * inversesqrt(m2) : vec2(0.0);
#endif
}

// The direction at a position in the map, unit; zero where there is none.
vec3 map_direction(vec2 place) {
#if ENVIRONMENT_LAYOUT == 1
    vec2 angles = vec2(1.0, 0.5) * 3.14159265 * place;
    return vec3(sin(angles.x) * cos(angles.y), sin(angles.y), cos(angles.x) * cos(angles.y));
#elif ENVIRONMENT_LAYOUT == 2
    vec2 at;
    vec2 cell;
    to_cell(place, at, cell);
    vec3 turned = normalize(vec3(at, cell.y > 0.5 ? -1.0 : 1.0));
    return cell.x < 0.5 ? turned.zxy : cell.x < 1.5 ? turned.yzx : turned;
#elif ENVIRONMENT_LAYOUT == 3
    vec2 at;
    vec2 cell;
    to_cell(place, at, cell);
    vec3 front = vec3(2.0 * at, 1.0 - dot(at, at)) / (1.0 + dot(at, at));
    return cell.x > 0.5 ? vec3(front.xy, -front.z) : front;
#else
    float squared = 1.0 - dot(place, place);
    bool inside = squared >= 0.0 && all(lessThan(abs(place), vec2(1.0 - 2.0 / kMapSide)));
    return inside ? vec3(2.0 * sqrt(squared) * place, 2.0 * squared - 1.0) : vec3(0.0);
#endif
}
