// Light within a fold: a long groove between two walls whose slopes face each other (wrinkle.fold-light). `open` is the
// cosine of the slope, the sine of half the angle between the walls: the share of a wall's diffuse light that leaves the
// groove, and of the light around that reaches a wall; what does not leave falls on the other wall. All walls are taken
// as evenly lit, by means that are exact; folds are taken as V-shaped, as steep everywhere as where they are seen.
// Oren and Nayar, "Generalization of Lambert's Reflectance Model", 1994; infinite bounces as in Jimenez et al.,
// "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016.
// Techniques: wrinkle.fold-light

// Mean cosines of a light at a wall and at the one opposite. What passes the mouth of the groove falls on both together:
// a wall that is lit by less than it faces the light stands in the shadow of the other one. `n_l`: of the wall, `m_l`: of
// the mouth, the skin without its folds.
vec2 wall_cosines(float open, float n_l, float m_l) {
    float both = max(2.0 * open * m_l, 0.0);
    float own = clamp(n_l, 0.0, both);
    return vec2(own, both - own);
}

// Diffuse light of a wall of this albedo by that which reaches it, `own`, and the other one, with all bounces between.
vec3 wall_light(float open, vec3 albedo, vec3 own, float other) {
    vec3 bounced = albedo * (1.0 - open);
    return (own + bounced * other) / (1.0 - bounced * bounced);
}

// The same of light that comes from all around, of 1 on skin without folds.
vec3 wall_light_around(float open, vec3 albedo) {
    return open / (1.0 - albedo * (1.0 - open));
}
