// Where a particle was in the previous frame, for motion vectors.
// Techniques: particle.velocity

uniform vec2 since_previous;  // time since the previous frame [s]; displacement per acceleration in it [s^2]

// Previous position of a particle with this velocity and age now, under `pull`: acceleration at rest, drag. Second
// order in time for gravity and drag, first order for all other motion; clamped to its birth.
vec3 previous_position(vec3 position, vec3 velocity, float age, vec4 pull) {
    float time = min(since_previous.x, age);
    float bend = min(since_previous.y, time < since_previous.x ? 0.5 * time * time : since_previous.y);
    return position - velocity * time + bend * (pull.xyz - pull.w * velocity);
}
