// How fragment shaders interpolate what varies on a triangle (fakephong.texmap). Definition:
//   SCREEN_LINEAR  linear in screen space, like forward differences; otherwise perspective correct
// Techniques: fakephong.texmap

#ifdef SCREEN_LINEAR
#define INTERPOLATED noperspective
#else
#define INTERPOLATED smooth
#endif
