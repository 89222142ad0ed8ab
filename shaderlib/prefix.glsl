//! Gives each name of the library's GLSL modules the prefix `lamplight_`.
//!
//! Define `LAMPLIGHT_PREFIX` before the first include of a module. Modules include this file twice:
//! before their declarations, where it defines macros, and after them, where it undefines those.
//!
//! Made from the modules by `cargo xtask docs`: edit those, not this file.

#ifndef LAMPLIGHT_PREFIXED
#define LAMPLIGHT_PREFIXED

#define Accum lamplight_Accum
#define ComplexIor lamplight_ComplexIor
#define LEAST_ALPHA lamplight_LEAST_ALPHA
#define LEAST_WIDTH lamplight_LEAST_WIDTH
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
#define accumulate(p0, p1, p2, p3, p4, p5, p6, p7) lamplight_accumulate(p0, p1, p2, p3, p4, p5, p6, p7)
#define aces_hill(p0) lamplight_aces_hill(p0)
#define agx(p0) lamplight_agx(p0)
#define agx_blender(p0) lamplight_agx_blender(p0)
#define agx_curve(p0) lamplight_agx_curve(p0)
#define agx_curve_blender(p0) lamplight_agx_curve_blender(p0)
#define alpha_aniso(p0, p1) lamplight_alpha_aniso(p0, p1)
#define alpha_aniso_disney(p0, p1) lamplight_alpha_aniso_disney(p0, p1)
#define alpha_aniso_filament(p0, p1) lamplight_alpha_aniso_filament(p0, p1)
#define alpha_aniso_openpbr(p0, p1) lamplight_alpha_aniso_openpbr(p0, p1)
#define any_tangent(p0) lamplight_any_tangent(p0)
#define area_alpha(p0, p1, p2) lamplight_area_alpha(p0, p1, p2)
#define area_energy(p0, p1) lamplight_area_energy(p0, p1)
#define bent_reflection(p0, p1, p2, p3, p4) lamplight_bent_reflection(p0, p1, p2, p3, p4)
#define blend_rnm(p0, p1) lamplight_blend_rnm(p0, p1)
#define blend_udn(p0, p1) lamplight_blend_udn(p0, p1)
#define blend_whiteout(p0, p1) lamplight_blend_whiteout(p0, p1)
#define blinn_phong(p0, p1, p2, p3) lamplight_blinn_phong(p0, p1, p2, p3)
#define blinn_phong_fast(p0, p1, p2, p3) lamplight_blinn_phong_fast(p0, p1, p2, p3)
#define blinn_phong_half(p0, p1, p2, p3) lamplight_blinn_phong_half(p0, p1, p2, p3)
#define blinn_phong_hpg(p0, p1, p2, p3) lamplight_blinn_phong_hpg(p0, p1, p2, p3)
#define blinn_phong_normalized(p0, p1, p2, p3) lamplight_blinn_phong_normalized(p0, p1, p2, p3)
#define blur21(p0, p1, p2) lamplight_blur21(p0, p1, p2)
#define bounding_sphere(p0, p1, p2) lamplight_bounding_sphere(p0, p1, p2)
#define box_project(p0, p1, p2, p3, p4) lamplight_box_project(p0, p1, p2, p3, p4)
#define btdf_thin(p0, p1, p2, p3) lamplight_btdf_thin(p0, p1, p2, p3)
#define btdf_volume(p0, p1, p2, p3, p4) lamplight_btdf_volume(p0, p1, p2, p3, p4)
#define burley(p0, p1, p2, p3) lamplight_burley(p0, p1, p2, p3)
#define burley_albedo(p0, p1) lamplight_burley_albedo(p0, p1)
#define cascade_blend(p0, p1, p2) lamplight_cascade_blend(p0, p1, p2)
#define cascade_index(p0, p1) lamplight_cascade_index(p0, p1)
#define cascade_snap(p0, p1) lamplight_cascade_snap(p0, p1)
#define cascade_split(p0, p1, p2, p3, p4) lamplight_cascade_split(p0, p1, p2, p3, p4)
#define castano_row(p0, p1, p2, p3, p4) lamplight_castano_row(p0, p1, p2, p3, p4)
#define charlie_exponent(p0, p1) lamplight_charlie_exponent(p0, p1)
#define charlie_lambda(p0, p1) lamplight_charlie_lambda(p0, p1)
#define chebyshev(p0, p1, p2, p3) lamplight_chebyshev(p0, p1, p2, p3)
#define cluster_index(p0, p1, p2, p3, p4) lamplight_cluster_index(p0, p1, p2, p3, p4)
#define cluster_slice(p0, p1, p2, p3) lamplight_cluster_slice(p0, p1, p2, p3)
#define coat_darkening(p0, p1, p2, p3) lamplight_coat_darkening(p0, p1, p2, p3)
#define coat_f0(p0, p1) lamplight_coat_f0(p0, p1)
#define coat_mix(p0, p1, p2, p3) lamplight_coat_mix(p0, p1, p2, p3)
#define compare_tap(p0, p1, p2) lamplight_compare_tap(p0, p1, p2)
#define cone_exponent(p0, p1, p2) lamplight_cone_exponent(p0, p1, p2)
#define cone_hard(p0, p1) lamplight_cone_hard(p0, p1)
#define cone_hard_exclusive(p0, p1) lamplight_cone_hard_exclusive(p0, p1)
#define cone_scale_offset(p0, p1, p2) lamplight_cone_scale_offset(p0, p1, p2)
#define cone_smooth(p0, p1, p2) lamplight_cone_smooth(p0, p1, p2)
#define constant_bias(p0, p1) lamplight_constant_bias(p0, p1)
#define contact_hit(p0, p1, p2, p3) lamplight_contact_hit(p0, p1, p2, p3)
#define cookie_uv(p0, p1) lamplight_cookie_uv(p0, p1)
#define cornette_shanks(p0, p1) lamplight_cornette_shanks(p0, p1)
#define cosine_power(p0, p1) lamplight_cosine_power(p0, p1)
#define cube_bias(p0, p1, p2) lamplight_cube_bias(p0, p1, p2)
#define cube_compare(p0, p1, p2) lamplight_cube_compare(p0, p1, p2)
#define cube_depth(p0, p1, p2) lamplight_cube_depth(p0, p1, p2)
#define cube_texel(p0, p1) lamplight_cube_texel(p0, p1)
#define d_charlie(p0, p1) lamplight_d_charlie(p0, p1)
#define d_ggx(p0, p1, p2) lamplight_d_ggx(p0, p1, p2)
#define d_ggx_aniso(p0, p1, p2, p3, p4) lamplight_d_ggx_aniso(p0, p1, p2, p3, p4)
#define ddgi_chebyshev(p0, p1, p2, p3) lamplight_ddgi_chebyshev(p0, p1, p2, p3)
#define ddgi_crushed(p0, p1, p2, p3) lamplight_ddgi_crushed(p0, p1, p2, p3)
#define ddgi_weight(p0, p1, p2, p3, p4, p5) lamplight_ddgi_weight(p0, p1, p2, p3, p4, p5)
#define ddgi_weight_rtxgi(p0, p1, p2, p3, p4, p5) lamplight_ddgi_weight_rtxgi(p0, p1, p2, p3, p4, p5)
#define decay_cutoff(p0, p1, p2) lamplight_decay_cutoff(p0, p1, p2)
#define depth_view_igl(p0) lamplight_depth_view_igl(p0)
#define dfg_approx(p0, p1) lamplight_dfg_approx(p0, p1)
#define dfg_approx_hill(p0, p1) lamplight_dfg_approx_hill(p0, p1)
#define dfg_approx_karis(p0, p1) lamplight_dfg_approx_karis(p0, p1)
#define dfg_approx_lazarov(p0, p1) lamplight_dfg_approx_lazarov(p0, p1)
#define diffuse_transmission(p0, p1) lamplight_diffuse_transmission(p0, p1)
#define diffusion_cdf(p0, p1) lamplight_diffusion_cdf(p0, p1)
#define diffusion_profile(p0, p1) lamplight_diffusion_profile(p0, p1)
#define diffusion_s(p0) lamplight_diffusion_s(p0)
#define diffusion_sample(p0, p1) lamplight_diffusion_sample(p0, p1)
#define disk_irradiance(p0, p1, p2) lamplight_disk_irradiance(p0, p1, p2)
#define dispersion_ior(p0, p1) lamplight_dispersion_ior(p0, p1)
#define dither(p0, p1, p2) lamplight_dither(p0, p1, p2)
#define draine(p0, p1, p2) lamplight_draine(p0, p1, p2)
#define edge_fade(p0, p1) lamplight_edge_fade(p0, p1)
#define energy_compensation(p0, p1) lamplight_energy_compensation(p0, p1)
#define eon(p0, p1, p2, p3, p4) lamplight_eon(p0, p1, p2, p3, p4)
#define eon_albedo(p0, p1) lamplight_eon_albedo(p0, p1)
#define eon_g(p0) lamplight_eon_g(p0)
#define esm_moment(p0, p1) lamplight_esm_moment(p0, p1)
#define esm_visibility(p0, p1, p2) lamplight_esm_visibility(p0, p1, p2)
#define ev100(p0, p1, p2) lamplight_ev100(p0, p1, p2)
#define ev100_from_illuminance(p0) lamplight_ev100_from_illuminance(p0)
#define ev100_from_luminance(p0) lamplight_ev100_from_luminance(p0)
#define evsm_moments(p0, p1) lamplight_evsm_moments(p0, p1)
#define evsm_visibility(p0, p1, p2, p3, p4) lamplight_evsm_visibility(p0, p1, p2, p3, p4)
#define evsm_warp(p0, p1) lamplight_evsm_warp(p0, p1)
#define exposure(p0) lamplight_exposure(p0)
#define f0_from_ior(p0) lamplight_f0_from_ior(p0)
#define f_average_dielectric(p0) lamplight_f_average_dielectric(p0)
#define f_average_schlick(p0, p1) lamplight_f_average_schlick(p0, p1)
#define f_conductor(p0, p1, p2) lamplight_f_conductor(p0, p1, p2)
#define f_conductor_channel(p0, p1, p2) lamplight_f_conductor_channel(p0, p1, p2)
#define f_dielectric(p0, p1) lamplight_f_dielectric(p0, p1)
#define f_schlick(p0, p1, p2) lamplight_f_schlick(p0, p1, p2)
#define f_schlick_f82(p0, p1, p2) lamplight_f_schlick_f82(p0, p1, p2)
#define face_normal(p0, p1, p2) lamplight_face_normal(p0, p1, p2)
#define face_normal_area(p0, p1, p2) lamplight_face_normal_area(p0, p1, p2)
#define fd_wrap(p0, p1) lamplight_fd_wrap(p0, p1)
#define film_sensitivity(p0, p1) lamplight_film_sensitivity(p0, p1)
#define flip_if_back(p0, p1) lamplight_flip_if_back(p0, p1)
#define fog_droplet(p0, p1) lamplight_fog_droplet(p0, p1)
#define fog_exp(p0, p1) lamplight_fog_exp(p0, p1)
#define fog_exp2(p0, p1) lamplight_fog_exp2(p0, p1)
#define fog_height(p0, p1, p2, p3, p4, p5) lamplight_fog_height(p0, p1, p2, p3, p4, p5)
#define fog_linear(p0, p1, p2) lamplight_fog_linear(p0, p1, p2)
#define fog_scale_offset(p0, p1, p2) lamplight_fog_scale_offset(p0, p1, p2)
#define fog_transmittance(p0) lamplight_fog_transmittance(p0)
#define gaussian21(p0) lamplight_gaussian21(p0)
#define geomerics_channel(p0, p1, p2) lamplight_geomerics_channel(p0, p1, p2)
#define gt7(p0) lamplight_gt7(p0)
#define gt7_curve(p0) lamplight_gt7_curve(p0)
#define gtao_arc(p0, p1) lamplight_gtao_arc(p0, p1)
#define gtso(p0, p1, p2, p3) lamplight_gtso(p0, p1, p2, p3)
#define hable(p0) lamplight_hable(p0)
#define hable_channel(p0) lamplight_hable_channel(p0)
#define half_lambert(p0, p1) lamplight_half_lambert(p0, p1)
#define hard(p0, p1) lamplight_hard(p0, p1)
#define hash_pcg(p0) lamplight_hash_pcg(p0)
#define hemisphere(p0, p1, p2, p3) lamplight_hemisphere(p0, p1, p2, p3)
#define hemisphere_oglpg(p0, p1, p2, p3, p4) lamplight_hemisphere_oglpg(p0, p1, p2, p3, p4)
#define hemisphere_weight(p0, p1) lamplight_hemisphere_weight(p0, p1)
#define hemisphere_weight_sine(p0, p1) lamplight_hemisphere_weight_sine(p0, p1)
#define hg(p0, p1) lamplight_hg(p0, p1)
#define hlg_from_linear(p0) lamplight_hlg_from_linear(p0)
#define horizon_occlusion(p0, p1, p2) lamplight_horizon_occlusion(p0, p1, p2)
#define ibl_mix(p0, p1, p2, p3, p4) lamplight_ibl_mix(p0, p1, p2, p3, p4)
#define ictcp_from_nits(p0) lamplight_ictcp_from_nits(p0)
#define ies_u(p0) lamplight_ies_u(p0)
#define ies_uv(p0, p1, p2) lamplight_ies_uv(p0, p1, p2)
#define ign_time(p0, p1) lamplight_ign_time(p0, p1)
#define intensity_point(p0) lamplight_intensity_point(p0)
#define intensity_spot(p0, p1) lamplight_intensity_spot(p0, p1)
#define intensity_spot_filament(p0) lamplight_intensity_spot_filament(p0)
#define interleaved_gradient_noise(p0) lamplight_interleaved_gradient_noise(p0)
#define inverse3(p0) lamplight_inverse3(p0)
#define inverse_square(p0, p1) lamplight_inverse_square(p0, p1)
#define ior_artistic(p0, p1) lamplight_ior_artistic(p0, p1)
#define ior_from_f0(p0) lamplight_ior_from_f0(p0)
#define iridescence(p0, p1, p2, p3, p4) lamplight_iridescence(p0, p1, p2, p3, p4)
#define is_nan_bits(p0) lamplight_is_nan_bits(p0)
#define is_on_map(p0) lamplight_is_on_map(p0)
#define lambert(p0, p1) lamplight_lambert(p0, p1)
#define linear_from_hlg(p0) lamplight_linear_from_hlg(p0)
#define linear_from_srgb(p0) lamplight_linear_from_srgb(p0)
#define linear_from_srgb_channel(p0) lamplight_linear_from_srgb_channel(p0)
#define linear_radius(p0, p1) lamplight_linear_radius(p0, p1)
#define linearize_depth(p0, p1, p2) lamplight_linearize_depth(p0, p1, p2)
#define ltc_disk(p0, p1, p2, p3, p4, p5, p6) lamplight_ltc_disk(p0, p1, p2, p3, p4, p5, p6)
#define ltc_edge(p0, p1) lamplight_ltc_edge(p0, p1)
#define ltc_line(p0, p1, p2, p3, p4, p5, p6) lamplight_ltc_line(p0, p1, p2, p3, p4, p5, p6)
#define ltc_matrix(p0) lamplight_ltc_matrix(p0)
#define ltc_rect(p0, p1, p2, p3, p4) lamplight_ltc_rect(p0, p1, p2, p3, p4)
#define ltc_uv(p0, p1) lamplight_ltc_uv(p0, p1)
#define luminance_area(p0, p1) lamplight_luminance_area(p0, p1)
#define lvsm_layer(p0, p1) lamplight_lvsm_layer(p0, p1)
#define lvsm_moments(p0, p1) lamplight_lvsm_moments(p0, p1)
#define lvsm_range(p0, p1, p2) lamplight_lvsm_range(p0, p1, p2)
#define lvsm_visibility(p0, p1, p2, p3, p4) lamplight_lvsm_visibility(p0, p1, p2, p3, p4)
#define lvsm_warp(p0, p1) lamplight_lvsm_warp(p0, p1)
#define march_point(p0, p1, p2, p3, p4, p5) lamplight_march_point(p0, p1, p2, p3, p4, p5)
#define material_index(p0, p1) lamplight_material_index(p0, p1)
#define material_index_oglpg(p0, p1) lamplight_material_index_oglpg(p0, p1)
#define mean_blocker(p0, p1, p2, p3) lamplight_mean_blocker(p0, p1, p2, p3)
#define micro_shadow(p0, p1) lamplight_micro_shadow(p0, p1)
#define ms_lobe(p0, p1, p2, p3) lamplight_ms_lobe(p0, p1, p2, p3)
#define msm_dequantise(p0) lamplight_msm_dequantise(p0)
#define msm_moments(p0) lamplight_msm_moments(p0)
#define msm_quantise(p0) lamplight_msm_quantise(p0)
#define msm_visibility(p0, p1, p2) lamplight_msm_visibility(p0, p1, p2)
#define multibounce(p0, p1) lamplight_multibounce(p0, p1)
#define nearest_sphere(p0, p1, p2) lamplight_nearest_sphere(p0, p1, p2)
#define nearest_tube(p0, p1, p2, p3) lamplight_nearest_tube(p0, p1, p2, p3)
#define neutral(p0) lamplight_neutral(p0)
#define neutral_inverse(p0) lamplight_neutral_inverse(p0)
#define nits_from_ictcp(p0) lamplight_nits_from_ictcp(p0)
#define nits_from_pq(p0) lamplight_nits_from_pq(p0)
#define normal_matrix(p0) lamplight_normal_matrix(p0)
#define normal_offset(p0, p1, p2, p3, p4) lamplight_normal_offset(p0, p1, p2, p3, p4)
#define normalize_or_zero(p0) lamplight_normalize_or_zero(p0)
#define octahedral_decode(p0) lamplight_octahedral_decode(p0)
#define octahedral_encode(p0) lamplight_octahedral_encode(p0)
#define oren_nayar(p0, p1, p2, p3) lamplight_oren_nayar(p0, p1, p2, p3)
#define paraboloid_uv(p0) lamplight_paraboloid_uv(p0)
#define pcf_3x3(p0, p1) lamplight_pcf_3x3(p0, p1)
#define pcf_5x5(p0, p1) lamplight_pcf_5x5(p0, p1)
#define pcf_castano_3(p0, p1) lamplight_pcf_castano_3(p0, p1)
#define pcf_castano_5(p0, p1) lamplight_pcf_castano_5(p0, p1)
#define pcf_grid(p0, p1, p2) lamplight_pcf_grid(p0, p1, p2)
#define pcf_random16(p0, p1, p2, p3) lamplight_pcf_random16(p0, p1, p2, p3)
#define pcf_random16_hpg(p0, p1, p2, p3) lamplight_pcf_random16_hpg(p0, p1, p2, p3)
#define pcf_vogel(p0, p1, p2, p3, p4) lamplight_pcf_vogel(p0, p1, p2, p3, p4)
#define pcss(p0, p1, p2, p3, p4) lamplight_pcss(p0, p1, p2, p3, p4)
#define pcss_width(p0, p1, p2) lamplight_pcss_width(p0, p1, p2)
#define pcss_width_directional(p0, p1, p2) lamplight_pcss_width_directional(p0, p1, p2)
#define perturb_normal(p0, p1, p2) lamplight_perturb_normal(p0, p1, p2)
#define phong(p0, p1, p2, p3) lamplight_phong(p0, p1, p2, p3)
#define phong_fast(p0, p1, p2, p3) lamplight_phong_fast(p0, p1, p2, p3)
#define phong_igl(p0, p1, p2, p3) lamplight_phong_igl(p0, p1, p2, p3)
#define phong_oglpg_7_21(p0, p1, p2, p3) lamplight_phong_oglpg_7_21(p0, p1, p2, p3)
#define pixel_seed(p0) lamplight_pixel_seed(p0)
#define polynomial(p0, p1) lamplight_polynomial(p0, p1)
#define pq_from_nits(p0) lamplight_pq_from_nits(p0)
#define prefilter_lod(p0, p1) lamplight_prefilter_lod(p0, p1)
#define prefilter_lod_filament(p0, p1) lamplight_prefilter_lod_filament(p0, p1)
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
#define r2_sequence(p0) lamplight_r2_sequence(p0)
#define random_hpg(p0) lamplight_random_hpg(p0)
#define range_gltf(p0, p1) lamplight_range_gltf(p0, p1)
#define rayleigh_phase(p0) lamplight_rayleigh_phase(p0)
#define receiver_plane(p0, p1, p2) lamplight_receiver_plane(p0, p1, p2)
#define reflect_world(p0, p1, p2) lamplight_reflect_world(p0, p1, p2)
#define refract_exit(p0, p1, p2, p3) lamplight_refract_exit(p0, p1, p2, p3)
#define reinhard_extended(p0, p1) lamplight_reinhard_extended(p0, p1)
#define resolve(p0, p1, p2) lamplight_resolve(p0, p1, p2)
#define safe_normalize(p0, p1) lamplight_safe_normalize(p0, p1)
#define safe_pow(p0, p1) lamplight_safe_pow(p0, p1)
#define sample_directional(p0) lamplight_sample_directional(p0)
#define sample_ggx_visible(p0, p1, p2, p3) lamplight_sample_ggx_visible(p0, p1, p2, p3)
#define sample_light(p0, p1) lamplight_sample_light(p0, p1)
#define sample_point(p0, p1) lamplight_sample_point(p0, p1)
#define sample_spot(p0, p1) lamplight_sample_spot(p0, p1)
#define saturate_color(p0) lamplight_saturate_color(p0)
#define savsm(p0, p1, p2, p3, p4, p5) lamplight_savsm(p0, p1, p2, p3, p4, p5)
#define sdf_soft_smooth(p0) lamplight_sdf_soft_smooth(p0)
#define sdf_soft_step(p0, p1, p2, p3, p4) lamplight_sdf_soft_step(p0, p1, p2, p3, p4)
#define sh4_irradiance(p0, p1) lamplight_sh4_irradiance(p0, p1)
#define sh4_irradiance_geomerics(p0, p1) lamplight_sh4_irradiance_geomerics(p0, p1)
#define sh4_irradiance_zh3(p0, p1) lamplight_sh4_irradiance_zh3(p0, p1)
#define sh9_basis(p0) lamplight_sh9_basis(p0)
#define sh9_irradiance(p0, p1) lamplight_sh9_irradiance(p0, p1)
#define sh9_irradiance_clamped(p0, p1) lamplight_sh9_irradiance_clamped(p0, p1)
#define sh_window(p0, p1) lamplight_sh_window(p0, p1)
#define shade_ncl(p0, p1, p2, p3, p4, p5) lamplight_shade_ncl(p0, p1, p2, p3, p4, p5)
#define shade_oglpg_7_21(p0, p1, p2, p3, p4, p5, p6, p7) lamplight_shade_oglpg_7_21(p0, p1, p2, p3, p4, p5, p6, p7)
#define shadow_coord(p0, p1) lamplight_shadow_coord(p0, p1)
#define shadow_mix(p0, p1) lamplight_shadow_mix(p0, p1)
#define sheen_albedo(p0, p1) lamplight_sheen_albedo(p0, p1)
#define sheen_ltc(p0, p1) lamplight_sheen_ltc(p0, p1)
#define sheen_ltc_lobe(p0, p1) lamplight_sheen_ltc_lobe(p0, p1)
#define sheen_scale(p0, p1, p2) lamplight_sheen_scale(p0, p1, p2)
#define slice_depth(p0, p1, p2, p3) lamplight_slice_depth(p0, p1, p2, p3)
#define slope_bias(p0, p1, p2) lamplight_slope_bias(p0, p1, p2)
#define specular_aa(p0, p1, p2, p3, p4) lamplight_specular_aa(p0, p1, p2, p3, p4)
#define specular_f0(p0, p1, p2) lamplight_specular_f0(p0, p1, p2)
#define specular_occlusion(p0, p1, p2) lamplight_specular_occlusion(p0, p1, p2)
#define sphere_irradiance(p0, p1) lamplight_sphere_irradiance(p0, p1)
#define spheremap_decode(p0) lamplight_spheremap_decode(p0)
#define spheremap_encode(p0) lamplight_spheremap_encode(p0)
#define split_sum(p0, p1, p2) lamplight_split_sum(p0, p1, p2)
#define split_sum_multi(p0, p1, p2) lamplight_split_sum_multi(p0, p1, p2)
#define srgb_from_linear(p0) lamplight_srgb_from_linear(p0)
#define srgb_from_linear_channel(p0) lamplight_srgb_from_linear_channel(p0)
#define ssao_kernel(p0, p1) lamplight_ssao_kernel(p0, p1)
#define summed_corner(p0, p1) lamplight_summed_corner(p0, p1)
#define summed_moments(p0, p1, p2, p3) lamplight_summed_moments(p0, p1, p2, p3)
#define tonemap_aces(p0) lamplight_tonemap_aces(p0)
#define tonemap_reinhard(p0) lamplight_tonemap_reinhard(p0)
#define transmission_roughness(p0, p1) lamplight_transmission_roughness(p0, p1)
#define uchimura(p0) lamplight_uchimura(p0)
#define uchimura_channel(p0) lamplight_uchimura_channel(p0)
#define unit_float(p0) lamplight_unit_float(p0)
#define v_charlie(p0, p1, p2) lamplight_v_charlie(p0, p1, p2)
#define v_kelemen(p0) lamplight_v_kelemen(p0)
#define v_neubelt(p0, p1) lamplight_v_neubelt(p0, p1)
#define v_neubelt_fast(p0, p1) lamplight_v_neubelt_fast(p0, p1)
#define v_smith_ggx(p0, p1, p2) lamplight_v_smith_ggx(p0, p1, p2)
#define v_smith_ggx_aniso(p0, p1, p2, p3, p4, p5, p6, p7) lamplight_v_smith_ggx_aniso(p0, p1, p2, p3, p4, p5, p6, p7)
#define v_smith_ggx_fast(p0, p1, p2) lamplight_v_smith_ggx_fast(p0, p1, p2)
#define view_infinite() lamplight_view_infinite()
#define view_local(p0) lamplight_view_local(p0)
#define vogel_disk(p0, p1, p2) lamplight_vogel_disk(p0, p1, p2)
#define volume_transmittance(p0, p1, p2) lamplight_volume_transmittance(p0, p1, p2)
#define volume_transmittance_fast(p0, p1, p2) lamplight_volume_transmittance_fast(p0, p1, p2)
#define vsm_moments(p0) lamplight_vsm_moments(p0)
#define vsm_moments_slope(p0, p1, p2) lamplight_vsm_moments_slope(p0, p1, p2)
#define vsm_visibility(p0, p1, p2, p3, p4) lamplight_vsm_visibility(p0, p1, p2, p3, p4)
#define window(p0, p1) lamplight_window(p0, p1)
#define world_tangent(p0, p1) lamplight_world_tangent(p0, p1)
#define wrap(p0, p1, p2) lamplight_wrap(p0, p1, p2)

#else
#undef LAMPLIGHT_PREFIXED

#undef Accum
#undef ComplexIor
#undef LEAST_ALPHA
#undef LEAST_WIDTH
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
#undef aces_hill
#undef agx
#undef agx_blender
#undef agx_curve
#undef agx_curve_blender
#undef alpha_aniso
#undef alpha_aniso_disney
#undef alpha_aniso_filament
#undef alpha_aniso_openpbr
#undef any_tangent
#undef area_alpha
#undef area_energy
#undef bent_reflection
#undef blend_rnm
#undef blend_udn
#undef blend_whiteout
#undef blinn_phong
#undef blinn_phong_fast
#undef blinn_phong_half
#undef blinn_phong_hpg
#undef blinn_phong_normalized
#undef blur21
#undef bounding_sphere
#undef box_project
#undef btdf_thin
#undef btdf_volume
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
#undef coat_darkening
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
#undef cornette_shanks
#undef cosine_power
#undef cube_bias
#undef cube_compare
#undef cube_depth
#undef cube_texel
#undef d_charlie
#undef d_ggx
#undef d_ggx_aniso
#undef ddgi_chebyshev
#undef ddgi_crushed
#undef ddgi_weight
#undef ddgi_weight_rtxgi
#undef decay_cutoff
#undef depth_view_igl
#undef dfg_approx
#undef dfg_approx_hill
#undef dfg_approx_karis
#undef dfg_approx_lazarov
#undef diffuse_transmission
#undef diffusion_cdf
#undef diffusion_profile
#undef diffusion_s
#undef diffusion_sample
#undef disk_irradiance
#undef dispersion_ior
#undef dither
#undef draine
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
#undef f_average_dielectric
#undef f_average_schlick
#undef f_conductor
#undef f_conductor_channel
#undef f_dielectric
#undef f_schlick
#undef f_schlick_f82
#undef face_normal
#undef face_normal_area
#undef fd_wrap
#undef film_sensitivity
#undef flip_if_back
#undef fog_droplet
#undef fog_exp
#undef fog_exp2
#undef fog_height
#undef fog_linear
#undef fog_scale_offset
#undef fog_transmittance
#undef gaussian21
#undef geomerics_channel
#undef gt7
#undef gt7_curve
#undef gtao_arc
#undef gtso
#undef hable
#undef hable_channel
#undef half_lambert
#undef hard
#undef hash_pcg
#undef hemisphere
#undef hemisphere_oglpg
#undef hemisphere_weight
#undef hemisphere_weight_sine
#undef hg
#undef hlg_from_linear
#undef horizon_occlusion
#undef ibl_mix
#undef ictcp_from_nits
#undef ies_u
#undef ies_uv
#undef ign_time
#undef intensity_point
#undef intensity_spot
#undef intensity_spot_filament
#undef interleaved_gradient_noise
#undef inverse3
#undef inverse_square
#undef ior_artistic
#undef ior_from_f0
#undef iridescence
#undef is_nan_bits
#undef is_on_map
#undef lambert
#undef linear_from_hlg
#undef linear_from_srgb
#undef linear_from_srgb_channel
#undef linear_radius
#undef linearize_depth
#undef ltc_disk
#undef ltc_edge
#undef ltc_line
#undef ltc_matrix
#undef ltc_rect
#undef ltc_uv
#undef luminance_area
#undef lvsm_layer
#undef lvsm_moments
#undef lvsm_range
#undef lvsm_visibility
#undef lvsm_warp
#undef march_point
#undef material_index
#undef material_index_oglpg
#undef mean_blocker
#undef micro_shadow
#undef ms_lobe
#undef msm_dequantise
#undef msm_moments
#undef msm_quantise
#undef msm_visibility
#undef multibounce
#undef nearest_sphere
#undef nearest_tube
#undef neutral
#undef neutral_inverse
#undef nits_from_ictcp
#undef nits_from_pq
#undef normal_matrix
#undef normal_offset
#undef normalize_or_zero
#undef octahedral_decode
#undef octahedral_encode
#undef oren_nayar
#undef paraboloid_uv
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
#undef phong_fast
#undef phong_igl
#undef phong_oglpg_7_21
#undef pixel_seed
#undef polynomial
#undef pq_from_nits
#undef prefilter_lod
#undef prefilter_lod_filament
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
#undef r2_sequence
#undef random_hpg
#undef range_gltf
#undef rayleigh_phase
#undef receiver_plane
#undef reflect_world
#undef refract_exit
#undef reinhard_extended
#undef resolve
#undef safe_normalize
#undef safe_pow
#undef sample_directional
#undef sample_ggx_visible
#undef sample_light
#undef sample_point
#undef sample_spot
#undef saturate_color
#undef savsm
#undef sdf_soft_smooth
#undef sdf_soft_step
#undef sh4_irradiance
#undef sh4_irradiance_geomerics
#undef sh4_irradiance_zh3
#undef sh9_basis
#undef sh9_irradiance
#undef sh9_irradiance_clamped
#undef sh_window
#undef shade_ncl
#undef shade_oglpg_7_21
#undef shadow_coord
#undef shadow_mix
#undef sheen_albedo
#undef sheen_ltc
#undef sheen_ltc_lobe
#undef sheen_scale
#undef slice_depth
#undef slope_bias
#undef specular_aa
#undef specular_f0
#undef specular_occlusion
#undef sphere_irradiance
#undef spheremap_decode
#undef spheremap_encode
#undef split_sum
#undef split_sum_multi
#undef srgb_from_linear
#undef srgb_from_linear_channel
#undef ssao_kernel
#undef summed_corner
#undef summed_moments
#undef tonemap_aces
#undef tonemap_reinhard
#undef transmission_roughness
#undef uchimura
#undef uchimura_channel
#undef unit_float
#undef v_charlie
#undef v_kelemen
#undef v_neubelt
#undef v_neubelt_fast
#undef v_smith_ggx
#undef v_smith_ggx_aniso
#undef v_smith_ggx_fast
#undef view_infinite
#undef view_local
#undef vogel_disk
#undef volume_transmittance
#undef volume_transmittance_fast
#undef vsm_moments
#undef vsm_moments_slope
#undef vsm_visibility
#undef window
#undef world_tangent
#undef wrap

#endif
