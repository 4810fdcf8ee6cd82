/* postfx plugin ABI, major version 1. C11, also valid C++.
 *
 * A plugin is a shared object that exports ONE constant, `postfx_module_v1`, and nothing else. It never calls
 * OpenGL, allocates nothing for the host and keeps no state. C++ authors use <postfx/plugin.hpp>, which fills
 * these structs in.
 *
 * Rules that hold for every struct here:
 *  - the first member is struct_size = sizeof(the struct) as its writer knew it. Fields are only ever appended. A
 *    reader that finds a smaller size takes zero for what is missing; arrays carry their own stride for the same
 *    reason.
 *  - only fixed-width integers, doubles and pointers; strings are UTF-8, static, zero-terminated.
 *  - kinds and formats are words. A host that does not know a word refuses that effect and names the word.
 *  - no exception crosses; the host copies what it keeps.
 * All functions are called on one thread at a time; different threads may plan different chains at once.
 */
#ifndef POSTFX_PLUGIN_H
#define POSTFX_PLUGIN_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define POSTFX_ABI_MAJOR 1
#define POSTFX_ABI_MINOR 0
#define POSTFX_MODULE_SYMBOL "postfx_module_v1"

/* Parameter flags. */
#define POSTFX_PARAMETER_CONSTANT 1u     /* compiled into the shader; changing it compiles another program */
#define POSTFX_PARAMETER_HAS_IDENTITY 2u /* at `identity` the whole effect does nothing */
#define POSTFX_PARAMETER_LOGARITHMIC 4u  /* sliders should move in ratios */

typedef struct postfx_parameter {
    uint32_t struct_size;
    uint32_t flags;
    const char* id;   /* [a-z][a-z0-9_]*, unique in the effect; not enabled, quality, name */
    const char* kind; /* "float", "int", "bool", "choice" (an index), "color" (scene-linear RGB, 3 values) */
    const char* unit; /* "m", "mm", "px", "deg", "stops", "height" (fraction of picture height), ... or "" */
    const char* help; /* one line */
    double default_value[4];
    double minimum, maximum, step; /* inclusive; step 0 = continuous; for a color they bound each channel */
    double identity;
    const char* const* choices;
    uint32_t choice_count;
    uint32_t reserved;
} postfx_parameter;

typedef struct postfx_level {
    uint32_t struct_size;
    uint32_t reserved;
    const char* id; /* "low", "medium", "high", "ultra", "reference", "classic" */
    const char* help;
} postfx_level;

/* GLSL that travels in the module. `path` is where it was at build time, for reload; may be empty. */
typedef struct postfx_source {
    uint32_t struct_size;
    uint32_t reserved;
    const char* name; /* "glow_down.glsl" */
    const char* text;
    const char* path;
} postfx_source;

typedef struct postfx_camera {
    uint32_t struct_size;
    uint32_t orthographic;
    double tan_half_fov;    /* of the vertical field of view; 0 when orthographic */
    double vertical_extent; /* metres, when orthographic */
    double near_plane, far_plane;
    double depth_scale, depth_offset, sky_depth; /* see postfx/camera.hpp */
    double focus_distance;                       /* metres along the view axis; 0 = not known */
    /* Where the optical axis lies in the picture, right and up from its middle, in half widths and half heights; finite,
       not always within -1..1. 0, 0 with a lens that is not shifted. */
    double principal_point[2];
} postfx_camera;

/* What the host knows of the scene without looking at pixels: bounds that hold for every pixel. */
typedef struct postfx_scene {
    uint32_t struct_size;
    uint32_t reserved;
    /* Metres along the view axis, of any surface; not known: 0 and infinity. */
    double nearest, farthest;
    /* Metres from the eye to the farthest surface along its ray; not known: infinity. */
    double reach;
    /* Metres in the world, of any surface and the eye; not known: -infinity and infinity. */
    double lowest, highest;
    /* Attachments that are zero in every pixel (no emitter, no ambient light); "depth": nothing but sky. */
    const char* const* empty;
    uint32_t empty_count;
    uint32_t reserved2;
} postfx_scene;

struct postfx_effect;

/* What the host knows when it asks for a plan. Valid during the call. */
typedef struct postfx_request {
    uint32_t struct_size;
    uint32_t width, height; /* of the picture, pixels */
    uint32_t level;         /* index into the effect's levels */
    const struct postfx_effect* effect;
    const double* values; /* 4 per parameter, in the order of the effect's parameters, always within range */
    const postfx_camera* camera;
    const char* const* attachments; /* what the host can provide: "color", "depth", ... */
    uint32_t attachment_count;
    uint32_t reserved;
    const postfx_scene* scene;
    /* At most so many 8-bit codes of the displayed picture change when this effect's output changes by 1 in light, or
       by a share of 1 of itself (for small changes, of light that is not negative). Infinity: not known, because what
       follows does not say what it does to changes. */
    double codes_per_light, codes_per_share;
} postfx_request;

/* What an effect does to small changes of the light that comes in, at most, in any pixel: a change by the share s of
   itself plus the light a comes out as share_to_share * s of itself plus share_to_light * s + light_to_light * a. */
typedef struct postfx_gain {
    uint32_t struct_size;
    uint32_t reserved;
    double share_to_share, light_to_light, share_to_light;
} postfx_gain;

typedef uint32_t postfx_image; /* an image of the plan being made; 0 = none */

typedef struct postfx_input {
    uint32_t struct_size;
    postfx_image image;
    const char* name;   /* the sampler argument's name, for messages and reports */
    const char* filter; /* "nearest" or "linear"; sampling outside the image gives its edge */
} postfx_input;

/* A number that plan() computed: a member of the pass's parameter struct, or a constant compiled in. */
typedef struct postfx_number {
    uint32_t struct_size;
    uint32_t count; /* 1..4 components */
    const char* name;
    const char* kind; /* "float" or "int" */
    double value[4];
} postfx_number;

typedef struct postfx_pass {
    uint32_t struct_size;
    uint32_t reserved;
    const char* kind;   /* "fragment", or "compose": the function of its own pixel (exactly one, last) */
    const char* name;   /* unique within the effect's plan, for reports; may repeat the source's stem */
    const char* source; /* a postfx_source of this module */
    const postfx_input* inputs;
    uint32_t input_count, input_stride;
    const postfx_number* values;
    uint32_t value_count, value_stride;
    const postfx_number* constants;
    uint32_t constant_count, constant_stride;
    const char* const* formats; /* one per output: "rgba16f", ...; "" = the chain's working format */
    uint32_t output_count;
    uint32_t width, height; /* of every output, pixels, at least 1 */
    /* Not 0: the pass is drawn in tiles whose texel of this image is not 0 in its first channel. Others may be drawn
       too; where not, its outputs are 0. Which it is must make no difference, to the bit, to what the effect gives. A
       texel stands for tile_side x tile_side pixels of the pass; 32 is a good side. Not for "compose". */
    postfx_image where;
    uint32_t tile_side;
    uint32_t reserved2;
} postfx_pass;

/* A question that only the frame can answer. Its source has a function of what was found in every pixel of the
   inputs: vec2 name(Census first, ..., NameParams params), a DepthCensus for the depth attachment
   (shaders/postfx/census.glsl). The effect is skipped in frames where .x <= .y. */
typedef struct postfx_decision {
    uint32_t struct_size;
    uint32_t reserved;
    const char* kind;   /* of the skip: "exact", "code" or "visible" */
    const char* source; /* a postfx_source of this module */
    const postfx_input* inputs;
    uint32_t input_count, input_stride;
    const postfx_number* values;
    uint32_t value_count, value_stride;
    const postfx_number* constants;
    uint32_t constant_count, constant_stride;
    const char* compared; /* what .x is, for reports: "brightest light" */
    const char* limit;    /* what .y is: "threshold" */
} postfx_decision;

/* Given to plan(). Image handles live until plan() returns. */
typedef struct postfx_builder {
    uint32_t struct_size;
    uint32_t reserved;
    void* context;
    /* The effect changes nothing now. moment: "configuration" or "scene". kind: "exact" (E0), "code" (E1: at
       most one 8-bit code), "visible" (E2). Non-zero: the effect is skipped, declare nothing. 0: the chain does not
       allow skips of this kind (none at all when everything is to run); go on and declare the passes. */
    int32_t (*identity)(void* context, const char* moment, const char* kind, const char* reason);
    /* The effect can't do anything here, because something is missing. Declare nothing. */
    void (*lacks)(void* context, const char* reason);
    /* These values can't be used together; the chain is refused with this message. */
    void (*refuse)(void* context, const char* message);
    /* The stored picture as it reaches this effect. */
    postfx_image (*color)(void* context);
    /* An attachment of the scene by name; 0 when the host has none of that name. */
    postfx_image (*attachment)(void* context, const char* name);
    /* Declare a pass. Returns the image of its first output (the others follow consecutively); 0 for
     * "compose". */
    postfx_image (*pass)(void* context, const postfx_pass* pass);
    /* At most once, before any pass. Its inputs are color() and attachments. */
    void (*decide)(void* context, const postfx_decision* decision);
    /* Size of an image of this plan, pixels. */
    void (*size)(void* context, postfx_image image, uint32_t* width, uint32_t* height);
    /* The effect found a mistake of its own, which no other values mend; the chain is refused with this message. */
    void (*fail)(void* context, const char* message);
} postfx_builder;

typedef struct postfx_effect {
    uint32_t struct_size;
    uint32_t min_host_minor;
    const char* id;      /* [a-z][a-z0-9_]* */
    const char* version; /* "1.0.0" */
    const char* help;    /* one line */
    const char* stage; /* "scene" (works on scene-linear light), "scene_to_display" (a tone map), "display" */
    const postfx_parameter* parameters;
    uint32_t parameter_count, parameter_stride;
    const char* const* reads; /* attachments that it may read besides the colour: "depth", "normal", ... */
    uint32_t read_count;
    uint32_t default_level; /* index into levels */
    const postfx_level* levels;
    uint32_t level_count, level_stride;
    /* Pure: same request, same calls. Returns 0, or non-zero after refuse() or fail(). */
    int32_t (*plan)(const postfx_request* request, const postfx_builder* builder);
    /* Pure. Null: not known; then no effect in front of this one is skipped for changing less than a code. */
    void (*gain)(const postfx_request* request, postfx_gain* gain);
} postfx_effect;

typedef struct postfx_module {
    uint32_t struct_size;
    uint32_t abi_major, abi_minor;
    uint32_t effect_count;
    const postfx_effect* const* effects;
    const postfx_source* sources;
    uint32_t source_count, source_stride;
} postfx_module;

/* The plugin defines:  const postfx_module postfx_module_v1; */

#ifdef __cplusplus
}
#endif

#endif
