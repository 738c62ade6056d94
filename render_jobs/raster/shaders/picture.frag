#version 330 core
// Linear light: a diffuse and a glossy lobe for every light, a hemisphere of ambient light, one shadow.
const int MAX_LIGHTS = 16;
const float PI = 3.14159265;

centroid in vec3 world;
centroid in vec3 world_normal;
centroid in vec3 in_shadow_map;
centroid in vec2 texture_at;

uniform vec3 eye;
uniform vec3 base_color;
uniform vec3 emission;
uniform float roughness;
uniform float metallic;
uniform float specular;
uniform bool smooth_shading;
uniform bool one_sided;
uniform bool has_texture;
uniform bool cut_alpha;
uniform bool blend_alpha;
uniform sampler2D base_texture;

uniform vec3 ambient_above;
uniform vec3 ambient_below;
uniform int num_lights;
uniform vec4 light_position[MAX_LIGHTS];  // w = 0: at infinity, xyz towards it
uniform vec3 light_color[MAX_LIGHTS];     // irradiance, or radiant intensity for a lamp
uniform vec4 light_axis[MAX_LIGHTS];      // the way it shines; w: cosine of half its opening, below -1 for all around
uniform bool light_is_flat[MAX_LIGHTS];   // an area lamp: brightest along its axis
uniform int shadow_of;                    // the light that has the shadow map, -1 for none
uniform sampler2D shadow_map;

out vec4 color;

vec3 to_linear(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}

float lit(float slope) {
    float bias = 0.0008 + 0.003 * (1.0 - slope);
    vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
    float sum = 0.0;
    for (int x = -2; x <= 2; x++)
        for (int y = -2; y <= 2; y++)
            sum += in_shadow_map.z - bias > texture(shadow_map, in_shadow_map.xy + vec2(x, y) * texel).r ? 0.0 : 1.0;
    bool outside = any(lessThan(in_shadow_map, vec3(0.0))) || any(greaterThan(in_shadow_map, vec3(1.0)));
    return outside ? 1.0 : sum / 25.0;
}

vec3 incoming(int i, vec3 n, out vec3 towards) {
    if (light_position[i].w == 0.0) {
        towards = normalize(light_position[i].xyz);
        return light_color[i];
    }
    vec3 offset = light_position[i].xyz - world;
    towards = normalize(offset);
    float along = dot(-towards, light_axis[i].xyz);
    if (along < light_axis[i].w) return vec3(0.0);
    float share = light_is_flat[i] ? max(along, 0.0) : 1.0;
    return light_color[i] * share / max(dot(offset, offset), 0.01);
}

void main() {
    if (one_sided && !gl_FrontFacing) discard;
    vec4 painted = has_texture ? texture(base_texture, texture_at) : vec4(1.0);
    if (cut_alpha && painted.a < 0.5) discard;
    vec3 base = base_color * (has_texture ? to_linear(painted.rgb) : vec3(1.0));
    vec3 view = normalize(eye - world);
    vec3 n = normalize(smooth_shading ? world_normal : cross(dFdx(world), dFdy(world)));
    bool towards_us = smooth_shading ? gl_FrontFacing : dot(n, view) > 0.0;
    if (!towards_us) n = -n;
    vec3 f0 = mix(vec3(0.08 * specular), base, metallic);
    float a = max(roughness * roughness, 0.02);
    vec3 sum = emission + base * mix(ambient_below, ambient_above, 0.5 + 0.5 * n.z);
    for (int i = 0; i < num_lights; i++) {
        vec3 l;
        vec3 light = incoming(i, n, l);
        float slope = dot(n, l);
        if (slope <= 0.0) continue;
        if (i == shadow_of) light *= lit(slope);
        vec3 h = normalize(l + view);
        float nh = max(dot(n, h), 0.0);
        float d = nh * nh * (a * a - 1.0) + 1.0;
        float lh = max(dot(l, h), 0.0);
        float gloss = a * a / (PI * d * d) / (4.0 * max(lh * lh, 0.1) * (roughness + 0.5));
        vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(view, h), 0.0), 5.0);
        sum += light * slope * (base * (1.0 - metallic) / PI + fresnel * gloss);
    }
    color = vec4(sum, blend_alpha ? painted.a : 1.0);
}
