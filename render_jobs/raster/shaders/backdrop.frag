#version 330 core
// The environment map, equirectangular: the middle column lies along +x, rows run from the zenith down.
const float PI = 3.14159265;

uniform mat3 pixel_to_world;
uniform sampler2D environment;

out vec4 color;

void main() {
    vec3 ray = normalize(pixel_to_world * vec3(gl_FragCoord.xy, 1.0));
    vec2 at = vec2(0.5 - atan(ray.y, ray.x) / (2.0 * PI), acos(clamp(ray.z, -1.0, 1.0)) / PI);
    color = vec4(textureLod(environment, at, 0.0).rgb, 1.0);
}
