//! Gives each name of the library's GLSL modules the prefix `lamplight_`.
//!
//! Define `LAMPLIGHT_PREFIX` before the first include of a module. Modules include this file twice:
//! before their declarations, where it defines macros, and after them, where it undefines those.
//!
//! Made from the modules by `cargo xtask docs`: edit those, not this file.

#ifndef LAMPLIGHT_PREFIXED
#define LAMPLIGHT_PREFIXED

#define Accum lamplight_Accum
#define LIGHT_DIRECTIONAL lamplight_LIGHT_DIRECTIONAL
#define LIGHT_OFF lamplight_LIGHT_OFF
#define LIGHT_POINT lamplight_LIGHT_POINT
#define LIGHT_SPOT lamplight_LIGHT_SPOT
#define Light lamplight_Light
#define LightSample lamplight_LightSample
#define Material lamplight_Material
#define SMALLEST_NORMAL lamplight_SMALLEST_NORMAL
#define ShadowUv lamplight_ShadowUv
#define SplitSum lamplight_SplitSum
#define accumulate lamplight_accumulate
#define alpha_aniso lamplight_alpha_aniso
#define any_tangent lamplight_any_tangent
#define area_alpha lamplight_area_alpha
#define area_energy lamplight_area_energy
#define bent_reflection lamplight_bent_reflection
#define blinn_phong lamplight_blinn_phong
#define blinn_phong_half lamplight_blinn_phong_half
#define blinn_phong_hpg lamplight_blinn_phong_hpg
#define blinn_phong_normalized lamplight_blinn_phong_normalized
#define blur21 lamplight_blur21
#define bounding_sphere lamplight_bounding_sphere
#define btdf_thin lamplight_btdf_thin
#define burley lamplight_burley
#define burley_albedo lamplight_burley_albedo
#define cascade_blend lamplight_cascade_blend
#define cascade_index lamplight_cascade_index
#define cascade_snap lamplight_cascade_snap
#define cascade_split lamplight_cascade_split
#define castano_row lamplight_castano_row
#define charlie_exponent lamplight_charlie_exponent
#define charlie_lambda lamplight_charlie_lambda
#define chebyshev lamplight_chebyshev
#define cluster_index lamplight_cluster_index
#define cluster_slice lamplight_cluster_slice
#define coat_f0 lamplight_coat_f0
#define coat_mix lamplight_coat_mix
#define compare_tap lamplight_compare_tap
#define cone_exponent lamplight_cone_exponent
#define cone_hard lamplight_cone_hard
#define cone_hard_exclusive lamplight_cone_hard_exclusive
#define cone_scale_offset lamplight_cone_scale_offset
#define cone_smooth lamplight_cone_smooth
#define constant_bias lamplight_constant_bias
#define contact_hit lamplight_contact_hit
#define cookie_uv lamplight_cookie_uv
#define cube_bias lamplight_cube_bias
#define cube_compare lamplight_cube_compare
#define cube_depth lamplight_cube_depth
#define cube_texel lamplight_cube_texel
#define d_charlie lamplight_d_charlie
#define d_ggx lamplight_d_ggx
#define d_ggx_aniso lamplight_d_ggx_aniso
#define decay_cutoff lamplight_decay_cutoff
#define depth_view_igl lamplight_depth_view_igl
#define dfg_approx lamplight_dfg_approx
#define diffuse_transmission lamplight_diffuse_transmission
#define diffusion_cdf lamplight_diffusion_cdf
#define diffusion_profile lamplight_diffusion_profile
#define diffusion_s lamplight_diffusion_s
#define disk_irradiance lamplight_disk_irradiance
#define dispersion_ior lamplight_dispersion_ior
#define edge_fade lamplight_edge_fade
#define energy_compensation lamplight_energy_compensation
#define eon lamplight_eon
#define eon_albedo lamplight_eon_albedo
#define eon_g lamplight_eon_g
#define esm_moment lamplight_esm_moment
#define esm_visibility lamplight_esm_visibility
#define ev100 lamplight_ev100
#define ev100_from_illuminance lamplight_ev100_from_illuminance
#define ev100_from_luminance lamplight_ev100_from_luminance
#define evsm_moments lamplight_evsm_moments
#define evsm_visibility lamplight_evsm_visibility
#define evsm_warp lamplight_evsm_warp
#define exposure lamplight_exposure
#define f0_from_ior lamplight_f0_from_ior
#define f_average_schlick lamplight_f_average_schlick
#define f_conductor lamplight_f_conductor
#define f_conductor_channel lamplight_f_conductor_channel
#define f_dielectric lamplight_f_dielectric
#define f_schlick lamplight_f_schlick
#define f_schlick_f82 lamplight_f_schlick_f82
#define face_normal lamplight_face_normal
#define face_normal_area lamplight_face_normal_area
#define film_sensitivity lamplight_film_sensitivity
#define flip_if_back lamplight_flip_if_back
#define fog_exp lamplight_fog_exp
#define fog_exp2 lamplight_fog_exp2
#define fog_linear lamplight_fog_linear
#define gaussian21 lamplight_gaussian21
#define half_lambert lamplight_half_lambert
#define hard lamplight_hard
#define hash_pcg lamplight_hash_pcg
#define hemisphere lamplight_hemisphere
#define hemisphere_oglpg lamplight_hemisphere_oglpg
#define hemisphere_weight lamplight_hemisphere_weight
#define hemisphere_weight_sine lamplight_hemisphere_weight_sine
#define ibl_mix lamplight_ibl_mix
#define ies_u lamplight_ies_u
#define ies_uv lamplight_ies_uv
#define intensity_point lamplight_intensity_point
#define intensity_spot lamplight_intensity_spot
#define intensity_spot_filament lamplight_intensity_spot_filament
#define interleaved_gradient_noise lamplight_interleaved_gradient_noise
#define inverse3 lamplight_inverse3
#define inverse_square lamplight_inverse_square
#define ior_from_f0 lamplight_ior_from_f0
#define iridescence lamplight_iridescence
#define is_nan_bits lamplight_is_nan_bits
#define is_on_map lamplight_is_on_map
#define lambert lamplight_lambert
#define linear_from_srgb lamplight_linear_from_srgb
#define linear_from_srgb_channel lamplight_linear_from_srgb_channel
#define linear_radius lamplight_linear_radius
#define linearize_depth lamplight_linearize_depth
#define ltc_edge lamplight_ltc_edge
#define ltc_matrix lamplight_ltc_matrix
#define ltc_rect lamplight_ltc_rect
#define ltc_uv lamplight_ltc_uv
#define luminance_area lamplight_luminance_area
#define march_point lamplight_march_point
#define material_index lamplight_material_index
#define material_index_oglpg lamplight_material_index_oglpg
#define mean_blocker lamplight_mean_blocker
#define msm_dequantise lamplight_msm_dequantise
#define msm_moments lamplight_msm_moments
#define msm_quantise lamplight_msm_quantise
#define msm_visibility lamplight_msm_visibility
#define nearest_sphere lamplight_nearest_sphere
#define nearest_tube lamplight_nearest_tube
#define normal_matrix lamplight_normal_matrix
#define normal_offset lamplight_normal_offset
#define oren_nayar lamplight_oren_nayar
#define pcf_3x3 lamplight_pcf_3x3
#define pcf_5x5 lamplight_pcf_5x5
#define pcf_castano_3 lamplight_pcf_castano_3
#define pcf_castano_5 lamplight_pcf_castano_5
#define pcf_grid lamplight_pcf_grid
#define pcf_random16 lamplight_pcf_random16
#define pcf_random16_hpg lamplight_pcf_random16_hpg
#define pcf_vogel lamplight_pcf_vogel
#define pcss lamplight_pcss
#define pcss_width lamplight_pcss_width
#define pcss_width_directional lamplight_pcss_width_directional
#define perturb_normal lamplight_perturb_normal
#define phong lamplight_phong
#define phong_igl lamplight_phong_igl
#define phong_oglpg_7_21 lamplight_phong_oglpg_7_21
#define pixel_seed lamplight_pixel_seed
#define polynomial lamplight_polynomial
#define probe_breezeway lamplight_probe_breezeway
#define probe_campus_sunset lamplight_probe_campus_sunset
#define probe_eucalyptus_grove lamplight_probe_eucalyptus_grove
#define probe_funston_beach_sunset lamplight_probe_funston_beach_sunset
#define probe_galileos_tomb lamplight_probe_galileos_tomb
#define probe_grace_cathedral lamplight_probe_grace_cathedral
#define probe_old_town_square lamplight_probe_old_town_square
#define probe_old_town_square_6_digits lamplight_probe_old_town_square_6_digits
#define probe_st_peters_basilica lamplight_probe_st_peters_basilica
#define probe_uffizi_gallery lamplight_probe_uffizi_gallery
#define probe_vine_street_kitchen lamplight_probe_vine_street_kitchen
#define project lamplight_project
#define project_gl lamplight_project_gl
#define random_hpg lamplight_random_hpg
#define range_gltf lamplight_range_gltf
#define receiver_plane lamplight_receiver_plane
#define reflect_world lamplight_reflect_world
#define refract_exit lamplight_refract_exit
#define resolve lamplight_resolve
#define safe_normalize lamplight_safe_normalize
#define safe_pow lamplight_safe_pow
#define sample_directional lamplight_sample_directional
#define sample_light lamplight_sample_light
#define sample_point lamplight_sample_point
#define sample_spot lamplight_sample_spot
#define saturate_color lamplight_saturate_color
#define sdf_soft_smooth lamplight_sdf_soft_smooth
#define sdf_soft_step lamplight_sdf_soft_step
#define sh4_irradiance lamplight_sh4_irradiance
#define sh9_basis lamplight_sh9_basis
#define sh9_irradiance lamplight_sh9_irradiance
#define sh9_irradiance_clamped lamplight_sh9_irradiance_clamped
#define shade_ncl lamplight_shade_ncl
#define shade_oglpg_7_21 lamplight_shade_oglpg_7_21
#define shadow_coord lamplight_shadow_coord
#define shadow_mix lamplight_shadow_mix
#define sheen_albedo lamplight_sheen_albedo
#define sheen_scale lamplight_sheen_scale
#define slice_depth lamplight_slice_depth
#define slope_bias lamplight_slope_bias
#define specular_aa lamplight_specular_aa
#define specular_f0 lamplight_specular_f0
#define sphere_irradiance lamplight_sphere_irradiance
#define split_sum lamplight_split_sum
#define split_sum_multi lamplight_split_sum_multi
#define srgb_from_linear lamplight_srgb_from_linear
#define srgb_from_linear_channel lamplight_srgb_from_linear_channel
#define tonemap_aces lamplight_tonemap_aces
#define tonemap_reinhard lamplight_tonemap_reinhard
#define transmission_roughness lamplight_transmission_roughness
#define unit_float lamplight_unit_float
#define v_charlie lamplight_v_charlie
#define v_neubelt lamplight_v_neubelt
#define v_smith_ggx lamplight_v_smith_ggx
#define v_smith_ggx_aniso lamplight_v_smith_ggx_aniso
#define view_infinite lamplight_view_infinite
#define view_local lamplight_view_local
#define vogel_disk lamplight_vogel_disk
#define volume_transmittance lamplight_volume_transmittance
#define vsm_moments lamplight_vsm_moments
#define vsm_moments_slope lamplight_vsm_moments_slope
#define vsm_visibility lamplight_vsm_visibility
#define window lamplight_window
#define wrap lamplight_wrap
#define accumulate(p0, p1, p2, p3, p4, p5, p6, p7) lamplight_accumulate(p0, p1, p2, p3, p4, p5, p6, p7)
#define alpha_aniso(p0, p1) lamplight_alpha_aniso(p0, p1)
#define bent_reflection(p0, p1, p2, p3, p4) lamplight_bent_reflection(p0, p1, p2, p3, p4)
#define blinn_phong(p0, p1, p2, p3) lamplight_blinn_phong(p0, p1, p2, p3)
#define blinn_phong_half(p0, p1, p2, p3) lamplight_blinn_phong_half(p0, p1, p2, p3)
#define blinn_phong_hpg(p0, p1, p2, p3) lamplight_blinn_phong_hpg(p0, p1, p2, p3)
#define blinn_phong_normalized(p0, p1, p2, p3) lamplight_blinn_phong_normalized(p0, p1, p2, p3)
#define blur21(p0, p1, p2) lamplight_blur21(p0, p1, p2)
#define btdf_thin(p0, p1, p2, p3) lamplight_btdf_thin(p0, p1, p2, p3)
#define burley(p0, p1, p2, p3) lamplight_burley(p0, p1, p2, p3)
#define burley_albedo(p0, p1) lamplight_burley_albedo(p0, p1)
#define cascade_blend(p0, p1, p2) lamplight_cascade_blend(p0, p1, p2)
#define cascade_index(p0, p1) lamplight_cascade_index(p0, p1)
#define castano_row(p0, p1, p2, p3, p4) lamplight_castano_row(p0, p1, p2, p3, p4)
#define charlie_exponent(p0, p1) lamplight_charlie_exponent(p0, p1)
#define charlie_lambda(p0, p1) lamplight_charlie_lambda(p0, p1)
#define chebyshev(p0, p1, p2, p3) lamplight_chebyshev(p0, p1, p2, p3)
#define coat_f0(p0, p1) lamplight_coat_f0(p0, p1)
#define coat_mix(p0, p1, p2, p3) lamplight_coat_mix(p0, p1, p2, p3)
#define compare_tap(p0, p1, p2) lamplight_compare_tap(p0, p1, p2)
#define cone_exponent(p0, p1, p2) lamplight_cone_exponent(p0, p1, p2)
#define cone_hard(p0, p1) lamplight_cone_hard(p0, p1)
#define cone_hard_exclusive(p0, p1) lamplight_cone_hard_exclusive(p0, p1)
#define cone_scale_offset(p0, p1, p2) lamplight_cone_scale_offset(p0, p1, p2)
#define cone_smooth(p0, p1, p2) lamplight_cone_smooth(p0, p1, p2)
#define constant_bias(p0, p1) lamplight_constant_bias(p0, p1)
#define cube_compare(p0, p1, p2) lamplight_cube_compare(p0, p1, p2)
#define cube_depth(p0, p1, p2) lamplight_cube_depth(p0, p1, p2)
#define d_charlie(p0, p1) lamplight_d_charlie(p0, p1)
#define d_ggx(p0, p1, p2) lamplight_d_ggx(p0, p1, p2)
#define d_ggx_aniso(p0, p1, p2, p3, p4) lamplight_d_ggx_aniso(p0, p1, p2, p3, p4)
#define decay_cutoff(p0, p1, p2) lamplight_decay_cutoff(p0, p1, p2)
#define depth_view_igl(p0) lamplight_depth_view_igl(p0)
#define dfg_approx(p0, p1) lamplight_dfg_approx(p0, p1)
#define diffuse_transmission(p0, p1) lamplight_diffuse_transmission(p0, p1)
#define diffusion_cdf(p0, p1) lamplight_diffusion_cdf(p0, p1)
#define diffusion_profile(p0, p1) lamplight_diffusion_profile(p0, p1)
#define diffusion_s(p0) lamplight_diffusion_s(p0)
#define dispersion_ior(p0, p1) lamplight_dispersion_ior(p0, p1)
#define energy_compensation(p0, p1) lamplight_energy_compensation(p0, p1)
#define eon(p0, p1, p2, p3, p4) lamplight_eon(p0, p1, p2, p3, p4)
#define eon_albedo(p0, p1) lamplight_eon_albedo(p0, p1)
#define eon_g(p0) lamplight_eon_g(p0)
#define evsm_moments(p0, p1) lamplight_evsm_moments(p0, p1)
#define evsm_visibility(p0, p1, p2, p3, p4) lamplight_evsm_visibility(p0, p1, p2, p3, p4)
#define evsm_warp(p0, p1) lamplight_evsm_warp(p0, p1)
#define f0_from_ior(p0) lamplight_f0_from_ior(p0)
#define f_average_schlick(p0, p1) lamplight_f_average_schlick(p0, p1)
#define f_conductor(p0, p1, p2) lamplight_f_conductor(p0, p1, p2)
#define f_conductor_channel(p0, p1, p2) lamplight_f_conductor_channel(p0, p1, p2)
#define f_dielectric(p0, p1) lamplight_f_dielectric(p0, p1)
#define f_schlick(p0, p1, p2) lamplight_f_schlick(p0, p1, p2)
#define f_schlick_f82(p0, p1, p2) lamplight_f_schlick_f82(p0, p1, p2)
#define face_normal(p0, p1, p2) lamplight_face_normal(p0, p1, p2)
#define face_normal_area(p0, p1, p2) lamplight_face_normal_area(p0, p1, p2)
#define film_sensitivity(p0, p1) lamplight_film_sensitivity(p0, p1)
#define flip_if_back(p0, p1) lamplight_flip_if_back(p0, p1)
#define fog_exp(p0, p1) lamplight_fog_exp(p0, p1)
#define fog_exp2(p0, p1) lamplight_fog_exp2(p0, p1)
#define fog_linear(p0, p1, p2) lamplight_fog_linear(p0, p1, p2)
#define gaussian21(p0) lamplight_gaussian21(p0)
#define half_lambert(p0, p1) lamplight_half_lambert(p0, p1)
#define hard(p0, p1) lamplight_hard(p0, p1)
#define hash_pcg(p0) lamplight_hash_pcg(p0)
#define hemisphere(p0, p1, p2, p3) lamplight_hemisphere(p0, p1, p2, p3)
#define hemisphere_oglpg(p0, p1, p2, p3, p4) lamplight_hemisphere_oglpg(p0, p1, p2, p3, p4)
#define hemisphere_weight(p0, p1) lamplight_hemisphere_weight(p0, p1)
#define hemisphere_weight_sine(p0, p1) lamplight_hemisphere_weight_sine(p0, p1)
#define ibl_mix(p0, p1, p2, p3, p4) lamplight_ibl_mix(p0, p1, p2, p3, p4)
#define interleaved_gradient_noise(p0) lamplight_interleaved_gradient_noise(p0)
#define inverse3(p0) lamplight_inverse3(p0)
#define inverse_square(p0, p1) lamplight_inverse_square(p0, p1)
#define ior_from_f0(p0) lamplight_ior_from_f0(p0)
#define iridescence(p0, p1, p2, p3, p4) lamplight_iridescence(p0, p1, p2, p3, p4)
#define is_nan_bits(p0) lamplight_is_nan_bits(p0)
#define is_on_map(p0) lamplight_is_on_map(p0)
#define lambert(p0, p1) lamplight_lambert(p0, p1)
#define linear_from_srgb(p0) lamplight_linear_from_srgb(p0)
#define linear_from_srgb_channel(p0) lamplight_linear_from_srgb_channel(p0)
#define linear_radius(p0, p1) lamplight_linear_radius(p0, p1)
#define linearize_depth(p0, p1, p2) lamplight_linearize_depth(p0, p1, p2)
#define material_index(p0, p1) lamplight_material_index(p0, p1)
#define material_index_oglpg(p0, p1) lamplight_material_index_oglpg(p0, p1)
#define mean_blocker(p0, p1, p2, p3) lamplight_mean_blocker(p0, p1, p2, p3)
#define normal_matrix(p0) lamplight_normal_matrix(p0)
#define normal_offset(p0, p1, p2, p3, p4) lamplight_normal_offset(p0, p1, p2, p3, p4)
#define oren_nayar(p0, p1, p2, p3) lamplight_oren_nayar(p0, p1, p2, p3)
#define pcf_3x3(p0, p1) lamplight_pcf_3x3(p0, p1)
#define pcf_5x5(p0, p1) lamplight_pcf_5x5(p0, p1)
#define pcf_castano_3(p0, p1) lamplight_pcf_castano_3(p0, p1)
#define pcf_castano_5(p0, p1) lamplight_pcf_castano_5(p0, p1)
#define pcf_grid(p0, p1, p2) lamplight_pcf_grid(p0, p1, p2)
#define pcf_random16(p0, p1, p2, p3) lamplight_pcf_random16(p0, p1, p2, p3)
#define pcf_random16_hpg(p0, p1, p2, p3) lamplight_pcf_random16_hpg(p0, p1, p2, p3)
#define pcf_vogel(p0, p1, p2, p3, p4) lamplight_pcf_vogel(p0, p1, p2, p3, p4)
#define pcss(p0, p1, p2, p3, p4) lamplight_pcss(p0, p1, p2, p3, p4)
#define perturb_normal(p0, p1, p2) lamplight_perturb_normal(p0, p1, p2)
#define phong(p0, p1, p2, p3) lamplight_phong(p0, p1, p2, p3)
#define phong_igl(p0, p1, p2, p3) lamplight_phong_igl(p0, p1, p2, p3)
#define phong_oglpg_7_21(p0, p1, p2, p3) lamplight_phong_oglpg_7_21(p0, p1, p2, p3)
#define pixel_seed(p0) lamplight_pixel_seed(p0)
#define polynomial(p0, p1) lamplight_polynomial(p0, p1)
#define probe_breezeway() lamplight_probe_breezeway()
#define probe_campus_sunset() lamplight_probe_campus_sunset()
#define probe_eucalyptus_grove() lamplight_probe_eucalyptus_grove()
#define probe_funston_beach_sunset() lamplight_probe_funston_beach_sunset()
#define probe_galileos_tomb() lamplight_probe_galileos_tomb()
#define probe_grace_cathedral() lamplight_probe_grace_cathedral()
#define probe_old_town_square() lamplight_probe_old_town_square()
#define probe_old_town_square_6_digits() lamplight_probe_old_town_square_6_digits()
#define probe_st_peters_basilica() lamplight_probe_st_peters_basilica()
#define probe_uffizi_gallery() lamplight_probe_uffizi_gallery()
#define probe_vine_street_kitchen() lamplight_probe_vine_street_kitchen()
#define project(p0, p1) lamplight_project(p0, p1)
#define project_gl(p0, p1) lamplight_project_gl(p0, p1)
#define random_hpg(p0) lamplight_random_hpg(p0)
#define range_gltf(p0, p1) lamplight_range_gltf(p0, p1)
#define receiver_plane(p0, p1, p2) lamplight_receiver_plane(p0, p1, p2)
#define reflect_world(p0, p1, p2) lamplight_reflect_world(p0, p1, p2)
#define refract_exit(p0, p1, p2, p3) lamplight_refract_exit(p0, p1, p2, p3)
#define resolve(p0, p1, p2) lamplight_resolve(p0, p1, p2)
#define safe_normalize(p0, p1) lamplight_safe_normalize(p0, p1)
#define safe_pow(p0, p1) lamplight_safe_pow(p0, p1)
#define sample_directional(p0) lamplight_sample_directional(p0)
#define sample_light(p0, p1) lamplight_sample_light(p0, p1)
#define sample_point(p0, p1) lamplight_sample_point(p0, p1)
#define sample_spot(p0, p1) lamplight_sample_spot(p0, p1)
#define saturate_color(p0) lamplight_saturate_color(p0)
#define sh4_irradiance(p0, p1) lamplight_sh4_irradiance(p0, p1)
#define sh9_basis(p0) lamplight_sh9_basis(p0)
#define sh9_irradiance(p0, p1) lamplight_sh9_irradiance(p0, p1)
#define sh9_irradiance_clamped(p0, p1) lamplight_sh9_irradiance_clamped(p0, p1)
#define shade_ncl(p0, p1, p2, p3, p4, p5) lamplight_shade_ncl(p0, p1, p2, p3, p4, p5)
#define shade_oglpg_7_21(p0, p1, p2, p3, p4, p5, p6, p7) lamplight_shade_oglpg_7_21(p0, p1, p2, p3, p4, p5, p6, p7)
#define shadow_coord(p0, p1) lamplight_shadow_coord(p0, p1)
#define shadow_mix(p0, p1) lamplight_shadow_mix(p0, p1)
#define sheen_albedo(p0, p1) lamplight_sheen_albedo(p0, p1)
#define sheen_scale(p0, p1, p2) lamplight_sheen_scale(p0, p1, p2)
#define slope_bias(p0, p1, p2) lamplight_slope_bias(p0, p1, p2)
#define specular_aa(p0, p1, p2, p3, p4) lamplight_specular_aa(p0, p1, p2, p3, p4)
#define specular_f0(p0, p1, p2) lamplight_specular_f0(p0, p1, p2)
#define split_sum(p0, p1, p2) lamplight_split_sum(p0, p1, p2)
#define split_sum_multi(p0, p1, p2) lamplight_split_sum_multi(p0, p1, p2)
#define srgb_from_linear(p0) lamplight_srgb_from_linear(p0)
#define srgb_from_linear_channel(p0) lamplight_srgb_from_linear_channel(p0)
#define tonemap_aces(p0) lamplight_tonemap_aces(p0)
#define tonemap_reinhard(p0) lamplight_tonemap_reinhard(p0)
#define transmission_roughness(p0, p1) lamplight_transmission_roughness(p0, p1)
#define unit_float(p0) lamplight_unit_float(p0)
#define v_charlie(p0, p1, p2) lamplight_v_charlie(p0, p1, p2)
#define v_neubelt(p0, p1) lamplight_v_neubelt(p0, p1)
#define v_smith_ggx(p0, p1, p2) lamplight_v_smith_ggx(p0, p1, p2)
#define v_smith_ggx_aniso(p0, p1, p2, p3, p4, p5, p6, p7) lamplight_v_smith_ggx_aniso(p0, p1, p2, p3, p4, p5, p6, p7)
#define view_infinite() lamplight_view_infinite()
#define view_local(p0) lamplight_view_local(p0)
#define vogel_disk(p0, p1, p2) lamplight_vogel_disk(p0, p1, p2)
#define volume_transmittance(p0, p1, p2) lamplight_volume_transmittance(p0, p1, p2)
#define vsm_moments(p0) lamplight_vsm_moments(p0)
#define vsm_moments_slope(p0, p1, p2) lamplight_vsm_moments_slope(p0, p1, p2)
#define vsm_visibility(p0, p1, p2, p3, p4) lamplight_vsm_visibility(p0, p1, p2, p3, p4)
#define window(p0, p1) lamplight_window(p0, p1)
#define wrap(p0, p1, p2) lamplight_wrap(p0, p1, p2)

#else
#undef LAMPLIGHT_PREFIXED

#undef Accum
#undef LIGHT_DIRECTIONAL
#undef LIGHT_OFF
#undef LIGHT_POINT
#undef LIGHT_SPOT
#undef Light
#undef LightSample
#undef Material
#undef SMALLEST_NORMAL
#undef ShadowUv
#undef SplitSum
#undef accumulate
#undef alpha_aniso
#undef any_tangent
#undef area_alpha
#undef area_energy
#undef bent_reflection
#undef blinn_phong
#undef blinn_phong_half
#undef blinn_phong_hpg
#undef blinn_phong_normalized
#undef blur21
#undef bounding_sphere
#undef btdf_thin
#undef burley
#undef burley_albedo
#undef cascade_blend
#undef cascade_index
#undef cascade_snap
#undef cascade_split
#undef castano_row
#undef charlie_exponent
#undef charlie_lambda
#undef chebyshev
#undef cluster_index
#undef cluster_slice
#undef coat_f0
#undef coat_mix
#undef compare_tap
#undef cone_exponent
#undef cone_hard
#undef cone_hard_exclusive
#undef cone_scale_offset
#undef cone_smooth
#undef constant_bias
#undef contact_hit
#undef cookie_uv
#undef cube_bias
#undef cube_compare
#undef cube_depth
#undef cube_texel
#undef d_charlie
#undef d_ggx
#undef d_ggx_aniso
#undef decay_cutoff
#undef depth_view_igl
#undef dfg_approx
#undef diffuse_transmission
#undef diffusion_cdf
#undef diffusion_profile
#undef diffusion_s
#undef disk_irradiance
#undef dispersion_ior
#undef edge_fade
#undef energy_compensation
#undef eon
#undef eon_albedo
#undef eon_g
#undef esm_moment
#undef esm_visibility
#undef ev100
#undef ev100_from_illuminance
#undef ev100_from_luminance
#undef evsm_moments
#undef evsm_visibility
#undef evsm_warp
#undef exposure
#undef f0_from_ior
#undef f_average_schlick
#undef f_conductor
#undef f_conductor_channel
#undef f_dielectric
#undef f_schlick
#undef f_schlick_f82
#undef face_normal
#undef face_normal_area
#undef film_sensitivity
#undef flip_if_back
#undef fog_exp
#undef fog_exp2
#undef fog_linear
#undef gaussian21
#undef half_lambert
#undef hard
#undef hash_pcg
#undef hemisphere
#undef hemisphere_oglpg
#undef hemisphere_weight
#undef hemisphere_weight_sine
#undef ibl_mix
#undef ies_u
#undef ies_uv
#undef intensity_point
#undef intensity_spot
#undef intensity_spot_filament
#undef interleaved_gradient_noise
#undef inverse3
#undef inverse_square
#undef ior_from_f0
#undef iridescence
#undef is_nan_bits
#undef is_on_map
#undef lambert
#undef linear_from_srgb
#undef linear_from_srgb_channel
#undef linear_radius
#undef linearize_depth
#undef ltc_edge
#undef ltc_matrix
#undef ltc_rect
#undef ltc_uv
#undef luminance_area
#undef march_point
#undef material_index
#undef material_index_oglpg
#undef mean_blocker
#undef msm_dequantise
#undef msm_moments
#undef msm_quantise
#undef msm_visibility
#undef nearest_sphere
#undef nearest_tube
#undef normal_matrix
#undef normal_offset
#undef oren_nayar
#undef pcf_3x3
#undef pcf_5x5
#undef pcf_castano_3
#undef pcf_castano_5
#undef pcf_grid
#undef pcf_random16
#undef pcf_random16_hpg
#undef pcf_vogel
#undef pcss
#undef pcss_width
#undef pcss_width_directional
#undef perturb_normal
#undef phong
#undef phong_igl
#undef phong_oglpg_7_21
#undef pixel_seed
#undef polynomial
#undef probe_breezeway
#undef probe_campus_sunset
#undef probe_eucalyptus_grove
#undef probe_funston_beach_sunset
#undef probe_galileos_tomb
#undef probe_grace_cathedral
#undef probe_old_town_square
#undef probe_old_town_square_6_digits
#undef probe_st_peters_basilica
#undef probe_uffizi_gallery
#undef probe_vine_street_kitchen
#undef project
#undef project_gl
#undef random_hpg
#undef range_gltf
#undef receiver_plane
#undef reflect_world
#undef refract_exit
#undef resolve
#undef safe_normalize
#undef safe_pow
#undef sample_directional
#undef sample_light
#undef sample_point
#undef sample_spot
#undef saturate_color
#undef sdf_soft_smooth
#undef sdf_soft_step
#undef sh4_irradiance
#undef sh9_basis
#undef sh9_irradiance
#undef sh9_irradiance_clamped
#undef shade_ncl
#undef shade_oglpg_7_21
#undef shadow_coord
#undef shadow_mix
#undef sheen_albedo
#undef sheen_scale
#undef slice_depth
#undef slope_bias
#undef specular_aa
#undef specular_f0
#undef sphere_irradiance
#undef split_sum
#undef split_sum_multi
#undef srgb_from_linear
#undef srgb_from_linear_channel
#undef tonemap_aces
#undef tonemap_reinhard
#undef transmission_roughness
#undef unit_float
#undef v_charlie
#undef v_neubelt
#undef v_smith_ggx
#undef v_smith_ggx_aniso
#undef view_infinite
#undef view_local
#undef vogel_disk
#undef volume_transmittance
#undef vsm_moments
#undef vsm_moments_slope
#undef vsm_visibility
#undef window
#undef wrap
#undef accumulate
#undef alpha_aniso
#undef bent_reflection
#undef blinn_phong
#undef blinn_phong_half
#undef blinn_phong_hpg
#undef blinn_phong_normalized
#undef blur21
#undef btdf_thin
#undef burley
#undef burley_albedo
#undef cascade_blend
#undef cascade_index
#undef castano_row
#undef charlie_exponent
#undef charlie_lambda
#undef chebyshev
#undef coat_f0
#undef coat_mix
#undef compare_tap
#undef cone_exponent
#undef cone_hard
#undef cone_hard_exclusive
#undef cone_scale_offset
#undef cone_smooth
#undef constant_bias
#undef cube_compare
#undef cube_depth
#undef d_charlie
#undef d_ggx
#undef d_ggx_aniso
#undef decay_cutoff
#undef depth_view_igl
#undef dfg_approx
#undef diffuse_transmission
#undef diffusion_cdf
#undef diffusion_profile
#undef diffusion_s
#undef dispersion_ior
#undef energy_compensation
#undef eon
#undef eon_albedo
#undef eon_g
#undef evsm_moments
#undef evsm_visibility
#undef evsm_warp
#undef f0_from_ior
#undef f_average_schlick
#undef f_conductor
#undef f_conductor_channel
#undef f_dielectric
#undef f_schlick
#undef f_schlick_f82
#undef face_normal
#undef face_normal_area
#undef film_sensitivity
#undef flip_if_back
#undef fog_exp
#undef fog_exp2
#undef fog_linear
#undef gaussian21
#undef half_lambert
#undef hard
#undef hash_pcg
#undef hemisphere
#undef hemisphere_oglpg
#undef hemisphere_weight
#undef hemisphere_weight_sine
#undef ibl_mix
#undef interleaved_gradient_noise
#undef inverse3
#undef inverse_square
#undef ior_from_f0
#undef iridescence
#undef is_nan_bits
#undef is_on_map
#undef lambert
#undef linear_from_srgb
#undef linear_from_srgb_channel
#undef linear_radius
#undef linearize_depth
#undef material_index
#undef material_index_oglpg
#undef mean_blocker
#undef normal_matrix
#undef normal_offset
#undef oren_nayar
#undef pcf_3x3
#undef pcf_5x5
#undef pcf_castano_3
#undef pcf_castano_5
#undef pcf_grid
#undef pcf_random16
#undef pcf_random16_hpg
#undef pcf_vogel
#undef pcss
#undef perturb_normal
#undef phong
#undef phong_igl
#undef phong_oglpg_7_21
#undef pixel_seed
#undef polynomial
#undef probe_breezeway
#undef probe_campus_sunset
#undef probe_eucalyptus_grove
#undef probe_funston_beach_sunset
#undef probe_galileos_tomb
#undef probe_grace_cathedral
#undef probe_old_town_square
#undef probe_old_town_square_6_digits
#undef probe_st_peters_basilica
#undef probe_uffizi_gallery
#undef probe_vine_street_kitchen
#undef project
#undef project_gl
#undef random_hpg
#undef range_gltf
#undef receiver_plane
#undef reflect_world
#undef refract_exit
#undef resolve
#undef safe_normalize
#undef safe_pow
#undef sample_directional
#undef sample_light
#undef sample_point
#undef sample_spot
#undef saturate_color
#undef sh4_irradiance
#undef sh9_basis
#undef sh9_irradiance
#undef sh9_irradiance_clamped
#undef shade_ncl
#undef shade_oglpg_7_21
#undef shadow_coord
#undef shadow_mix
#undef sheen_albedo
#undef sheen_scale
#undef slope_bias
#undef specular_aa
#undef specular_f0
#undef split_sum
#undef split_sum_multi
#undef srgb_from_linear
#undef srgb_from_linear_channel
#undef tonemap_aces
#undef tonemap_reinhard
#undef transmission_roughness
#undef unit_float
#undef v_charlie
#undef v_neubelt
#undef v_smith_ggx
#undef v_smith_ggx_aniso
#undef view_infinite
#undef view_local
#undef vogel_disk
#undef volume_transmittance
#undef vsm_moments
#undef vsm_moments_slope
#undef vsm_visibility
#undef window
#undef wrap

#endif
