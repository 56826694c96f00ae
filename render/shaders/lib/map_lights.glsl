// The coordinates of each light of a vertex. Include after lib/map_vertex.glsl and a definition of
//     vec2 map_coordinates(LitPoint p, vec3 to_light)
// Definitions:
//   MAP_DIFFUSE     the texture holds diffuse light; there are no highlights
//   BLINN_DIFFUSE   diffuse light is also read from a texture: the normal projected on the plane orthogonal to L
//   HW_FIRST_LIGHT  only the first light
// Techniques: fakephong.blinn-map
void main() {
    LitPoint p = put_vertex();
    int end = kEveryLight;
#ifdef HW_FIRST_LIGHT
    end = 1;
#endif
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        map_at[k] = vec3(1.0, 0.0, 0.0);
        map_factor[k] = vec3(0.0);
#ifdef BLINN_DIFFUSE
        diffuse_at[k] = vec2(1.0, 0.0);
        diffuse_factor[k] = vec3(0.0);
#endif
        if (k < min(p.single, end)) {
            Incoming light = single_light(p, k);
            map_at[k] = vec3(map_coordinates(p, light.to_light), dot(p.reflector.normal, light.to_light));
#ifdef MAP_DIFFUSE
            map_factor[k] = light.irradiance / kPi * p.reflector.diffuse;
#else
            map_factor[k] = light.irradiance / kPi * p.reflector.specular_0;
#endif
#ifdef BLINN_DIFFUSE
            diffuse_at[k] = plane_coordinates(p.reflector.normal, light.to_light);
            diffuse_factor[k] = light.irradiance / kPi * p.reflector.diffuse;
#endif
        }
    }
#ifdef MAP_DIFFUSE
    Reflected light = light_from(p, p.single, p.single > 0 ? kEveryLight : 0, end);
#elif defined(BLINN_DIFFUSE)
    Reflected light = light_from(p, p.single, p.single, end);
#else
    Reflected light = light_from(p, 0, p.single, end);
#endif
    diffuse = light.diffuse;
    specular = light.specular;
}
