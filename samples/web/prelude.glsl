// What WebGL 2 lacks of the viewer's shaders, ahead of each.
const ivec4 NO_VIEW = ivec4(0, 0, 0, 1); // no false colours; edges are smoothed
uniform sampler2D seen_picture, colour_picture;
uniform ivec2 picture_size;
uniform int level; // of the pyramid
uniform int row_offset; // the noise's slices lie one behind the other

#ifdef ROWS_DOWN
uvec3 invocation() { return uvec3(uint(gl_FragCoord.x), uint(picture_size.y) - 1u - uint(gl_FragCoord.y), 0u); }
#else
uvec3 invocation() { return uvec3(uint(gl_FragCoord.x), uint(gl_FragCoord.y) + uint(row_offset), 0u); }
#endif

// The four texels round a corner, in textureGather's order.
vec4 gathered(sampler2D image, vec2 corner, int component) {
    ivec2 size = textureSize(image, 0), high = ivec2(floor(corner * vec2(size) + 0.5)), low = clamp(high - 1, ivec2(0), size - 1);
    high = clamp(high, ivec2(0), size - 1);
    vec4 sw = texelFetch(image, low, 0), se = texelFetch(image, ivec2(high.x, low.y), 0);
    vec4 nw = texelFetch(image, ivec2(low.x, high.y), 0), ne = texelFetch(image, high, 0);
    return component == 0 ? vec4(nw.x, ne.x, se.x, sw.x) : vec4(nw.y, ne.y, se.y, sw.y);
}
