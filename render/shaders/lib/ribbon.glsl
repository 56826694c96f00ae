// The edges of ribbons that face the camera.
// Techniques: engine.trail

const float kMaxMiter = 2.0;  // of an edge, in half widths
const float kEndOn = 1e-5;    // projected length of a segment as a fraction of its length, below which it is rounding

// Directions of the segments before and after `point`, projected along `to_camera` (unit). False if both are end-on.
bool ribbon_turn(vec3 before, vec3 point, vec3 after, vec3 to_camera, out vec3 came, out vec3 goes, out float shorter) {
    came = point - before;
    goes = after - point;
    came -= dot(came, to_camera) * to_camera;
    goes -= dot(goes, to_camera) * to_camera;
    float came_by = length(came);
    float goes_by = length(goes);
    shorter = min(came_by, goes_by);
    // The projection of an end-on segment is only rounding, in proportion to its length.
    bool came_end_on = came_by < max(kEndOn * distance(before, point), 1e-6);
    bool goes_end_on = goes_by < max(kEndOn * distance(point, after), 1e-6);
    if (came_end_on && goes_end_on) {
        return false;
    }
    came = came_end_on ? goes / goes_by : came / came_by;
    goes = goes_end_on ? came : goes / goes_by;
    return true;
}

// Offset from `point` to the left edge: perpendicular to the projected ribbon; at a turn, along the miter of its two
// segments. The miter is limited to kMaxMiter half widths, and by the length of the shorter segment, so that ends
// viewed head-on neither spike nor fold. `otherwise`: direction if both segments are end-on.
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
    float ratio = shorter / max(half_width, 1e-6);
    return half_width * min(miter, min(kMaxMiter, sqrt(1.0 + ratio * ratio))) * side;
}

// A corner of the join that fills the wedge on the outside of a turn between two segments with square ends, for a half
// width of 1: two triangles with `point` as their common corner. In w the coordinate across the ribbon, -1 .. 1.
vec4 ribbon_join(vec3 before, vec3 point, vec3 after, int vertex, vec3 to_camera, vec3 otherwise) {
    vec3 came;
    vec3 goes;
    float shorter;
    if (vertex == 1 || !ribbon_turn(before, point, after, to_camera, came, goes, shorter)) {
        return vec4(0.0);
    }
    float outer = dot(cross(came, goes), to_camera) >= 0.0 ? -1.0 : 1.0;
    vec3 bisector = came - goes;  // toward the outside
    vec3 direction = vertex == 0   ? outer * cross(to_camera, came)
                     : vertex == 3 ? outer * cross(to_camera, goes)
                     : dot(bisector, bisector) > 1e-6 ? normalize(bisector) : outer * cross(to_camera, came);
    return vec4(direction, outer);
}
