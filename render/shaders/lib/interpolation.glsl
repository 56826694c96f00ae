// How fragment shaders interpolate what varies on a triangle (fakephong.texmap). Definition:
//   SCREEN_LINEAR  linear on the screen, as forward differences have it; otherwise linear on the triangle
// Techniques: fakephong.texmap

#ifdef SCREEN_LINEAR
#define INTERPOLATED noperspective
#else
#define INTERPOLATED smooth
#endif
