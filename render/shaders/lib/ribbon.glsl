// The edges of ribbons that face the camera.
// Techniques: engine.trail

const float kMaxMiter = 2.0;  // half widths to an edge at most
const float kEndOn = 1e-5;    // pieces appear shorter than this share of their length only by rounding

// The directions of the pieces that meet, as they appear from `to_camera` (unit). False: both are seen end-on.
bool ribbon_turn(vec3 before, vec3 point, vec3 after, vec3 to_camera, out vec3 came, out vec3 goes, out float shorter) {
    came = point - before;
    goes = after - point;
    came -= dot(came, to_camera) * to_camera;
    goes -= dot(goes, to_camera) * to_camera;
    float came_by = length(came);
    float goes_by = length(goes);
    shorter = min(came_by, goes_by);
    // Seen end-on, what is left of a piece is rounding, in proportion to its length.
    bool came_end_on = came_by < max(kEndOn * distance(before, point), 1e-6);
    bool goes_end_on = goes_by < max(kEndOn * distance(point, after), 1e-6);
    if (came_end_on && goes_end_on) {
        return false;
    }
    came = came_end_on ? goes / goes_by : came / came_by;
    goes = goes_end_on ? came : goes / goes_by;
    return true;
}

// From `point` to its edge on the left: square to the ribbon as it appears, between its two pieces where it turns (a
// miter). That is no longer than kMaxMiter half widths nor, beyond its width, than the pieces are: so that ends seen
// head-on neither spike nor fold. `otherwise`: where both pieces are seen end-on.
vec3 ribbon_edge(vec3 before, vec3 point, vec3 after, vec3 to_camera, vec3 otherwise, float half_width) {
    vec3 came;
    vec3 goes;
    float shorter;
    if (!ribbon_turn(before, point, after, to_camera, came, goes, shorter)) {
        return half_width * otherwise;
    }
    vec3 both = came + goes;
    float miter = 2.0 / max(length(both), 1e-3);  // 1 over the cosine of half the turn
    vec3 side = dot(both, both) > 1e-6 ? cross(to_camera, normalize(both)) : came;
    float reach = shorter / max(half_width, 1e-6);
    return half_width * min(miter, min(kMaxMiter, sqrt(1.0 + reach * reach))) * side;
}

// A corner of the wedge that is open on the outside where two pieces meet that end squarely, for half a width of 1: rounded
// by two triangles with `point` as their common corner. In w what the ribbon has across there, -1 .. 1.
vec4 ribbon_join(vec3 before, vec3 point, vec3 after, int vertex, vec3 to_camera, vec3 otherwise) {
    vec3 came;
    vec3 goes;
    float shorter;
    if (vertex == 1 || !ribbon_turn(before, point, after, to_camera, came, goes, shorter)) {
        return vec4(0.0);
    }
    float outer = dot(cross(came, goes), to_camera) >= 0.0 ? -1.0 : 1.0;
    vec3 middle = came - goes;  // toward the outside
    vec3 direction = vertex == 0   ? outer * cross(to_camera, came)
                     : vertex == 3 ? outer * cross(to_camera, goes)
                     : dot(middle, middle) > 1e-6 ? normalize(middle) : outer * cross(to_camera, came);
    return vec4(direction, outer);
}
