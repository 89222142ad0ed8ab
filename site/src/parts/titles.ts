// What the pictures of the gallery are called, and in which order they are shown: what is worth a look
// first. The build stops at a preset that has no title here.

/** A part of the gallery: its presets, with their titles. */
export type Group = { title: string; presets: [name: string, title: string][] };

export const GROUPS: Group[] = [
    { title: "Scenes", presets: [
        ["tech_chess", "The end of a game"], ["tech_height_fog", "Height fog with a low sun"], ["tech_ddgi", "Probes of indirect light"],
        ["tech_tonemap", "AgX tone curve"], ["tech_deferred", "Deferred shading, forty lamps"], ["tech_clustered", "Clustered shading, sixty lamps"],
        ["tech_box_projection", "Box-projected reflections"], ["tech_fog", "Exponential fog"],
    ] },
    { title: "Surfaces", presets: [
        ["tech_ggx", "GGX and metals"], ["tech_gltf_clearcoat", "Clear coat"], ["tech_gltf_sheen", "Sheen"], ["tech_gltf_iridescence", "Iridescence"],
        ["tech_gltf_anisotropy", "Anisotropy"], ["tech_gltf_transmission", "Thin glass"], ["tech_gltf_volume", "Glass that bends light"],
        ["tech_gltf_dispersion", "Dispersion"], ["tech_gltf_diffuse_transmission", "Diffuse transmission"], ["tech_gltf_maps", "Textures of glTF"],
        ["tech_deferred_gltf", "glTF, deferred"], ["tech_oren_nayar", "Oren–Nayar"], ["tech_normal_map", "Normal map"], ["tech_prefilter", "Table of the split sum"],
    ] },
    { title: "Shadows", presets: [
        ["tech_cascades", "Cascades"], ["tech_pcss", "Percentage-closer soft shadows"], ["tech_vogel", "Vogel spiral"], ["tech_contact_shadows", "Contact shadows"],
        ["tech_esm", "Exponential shadow map"], ["tech_evsm", "Exponential variance shadow map"], ["tech_msm", "Moment shadow map"],
        ["tech_gtao", "Ground-truth ambient occlusion"], ["tech_occlusion_screen", "Occlusion on the screen"], ["tech_occlusion_map", "Occlusion map"],
    ] },
    { title: "Lamps", presets: [
        ["tech_area_rectangle", "Rectangular light"], ["tech_area_sphere", "Spherical light"], ["tech_area_tube", "Tubular light"],
        ["tech_ies", "Measured luminaires"], ["tech_cookie", "Projected picture"],
    ] },
    { title: "OpenGL Programming Guide", presets: [
        ["oglpg_7_13", "Gold in an environment map"], ["oglpg_7_13_diffuse", "Environment map, diffuse"], ["oglpg_7_13_mirror", "Environment map, mirror"],
        ["oglpg_7_8", "Ten lights in a loop"], ["oglpg_7_10", "Fourteen materials"], ["oglpg_7_11", "Two-sided materials"], ["oglpg_7_12", "Hemisphere light"],
        ["oglpg_7_21", "Shadow map"], ["oglpg_7_1", "Colour alone"], ["oglpg_7_2", "Ambient light"], ["oglpg_7_3", "Directional light"],
        ["oglpg_7_4", "Point light"], ["oglpg_7_5", "Spot light"], ["oglpg_7_6", "Point light, per vertex"],
        ["oglpg_7_14", "Spherical harmonics, as printed"], ["oglpg_7_14_old_town_square", "Old town square"], ["oglpg_7_14_grace_cathedral", "Grace Cathedral"],
        ["oglpg_7_14_eucalyptus_grove", "Eucalyptus grove"], ["oglpg_7_14_st_peters_basilica", "St. Peter’s Basilica"], ["oglpg_7_14_uffizi_gallery", "Uffizi Gallery"],
        ["oglpg_7_14_galileos_tomb", "Galileo’s tomb"], ["oglpg_7_14_vine_street_kitchen", "Vine Street kitchen"], ["oglpg_7_14_breezeway", "Breezeway"],
        ["oglpg_7_14_campus_sunset", "Campus at sunset"], ["oglpg_7_14_funston_beach_sunset", "Funston Beach at sunset"],
    ] },
    { title: "OpenGL: Build High Performance Graphics", presets: [
        ["hpg_1_fragment", "Blinn–Phong, per fragment"], ["hpg_1_vertex", "Blinn–Phong, per vertex"], ["hpg_2_directional", "Directional light"],
        ["hpg_3_point", "Point light"], ["hpg_4_spot", "Spot light"], ["hpg_5_shadow", "Hard shadow"], ["hpg_6_pcf_3x3", "PCF, nine comparisons"],
        ["hpg_6_pcf_5x5", "PCF, twenty-five comparisons"], ["hpg_6_pcf_random", "PCF at random places"], ["hpg_7_vsm", "Variance shadow map"],
    ] },
    { title: "Graphics for Games, tutorial 11", presets: [
        ["ncl_11_phong", "Phong"], ["ncl_11_gouraud", "Gouraud"], ["ncl_11_flat", "Flat"], ["ncl_11_lightmap", "Lightmap"],
        ["ncl_11_further_1", "Coloured highlights"], ["ncl_11_further_2", "Four lamps"], ["ncl_11_further_3", "A sun"], ["ncl_11_further_4", "A spot light"],
    ] },
    { title: "Working with lights and shadows", presets: [
        ["igl_2_spot", "Shadow of a spot light"], ["igl_2_cube", "Shadow of a point light"], ["igl_2_directional", "Shadow of a sun"], ["igl_2_shadow_map", "The shadow map"],
        ["igl_1_directional", "Directional light"], ["igl_1_point", "Point light"], ["igl_1_spot", "Spot light"], ["igl_1_ambient", "Spot light: ambient part"],
        ["igl_1_diffuse", "Spot light: diffuse part"], ["igl_1_specular", "Spot light: specular part"], ["igl_1_multiple", "Several lights"],
    ] },
];

/** The comparisons, with their titles. */
export const COMPARED: [name: string, title: string][] = [
    ["tone_curves", "Tone curves"], ["shadow_filters", "Filters of shadows"], ["biases", "Shadow bias"], ["attenuations", "Attenuations"],
    ["highlights", "Highlights"], ["shading_frequencies", "Flat, Gouraud, Phong"], ["diffuse_terms", "Diffuse terms"], ["box_projection", "Box projection"],
    ["cascades", "Cascades"], ["contact_shadows", "Contact shadows"], ["forward_curves", "Tone curves of a scene"], ["lights_of_a_model", "Lights of a model"],
    ["numbers_of_a_frame", "Linear and encoded"], ["powers_of_highlights", "Powers of highlights"], ["terms_of_a_hill", "Terms of a hill"], ["terms_of_light", "Terms of light"],
];

const TITLES = new Map(GROUPS.flatMap(({ presets }) => presets));

export const titleOf = (preset: string): string => TITLES.get(preset) ?? preset;
