// Moves a vertex along its normal (shade.inflate). The normal need not be unit; a zero normal moves nothing.
// Techniques: shade.inflate
vec3 inflate(vec3 position, vec3 normal, float distance) {
    return position + distance * inversesqrt(max(dot(normal, normal), 1e-30)) * normal;
}
