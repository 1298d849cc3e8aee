//! SIMD width chosen at run time: one body, compiled once for the baseline and once for AVX2.
//! Floor 0. A release binary runs on any x86-64 and is fast on a new one; other platforms get the
//! baseline body.
//!
//! The wide version enables AVX2 only and never contracts a multiply and an add, so both versions
//! compute the same bits.

/// Wraps functions so that their body is compiled for the baseline and for AVX2, and the processor
/// picks.
///
/// The body must be plain loops over slices or arrays, which the compiler vectorizes, and call only
/// `#[inline(always)]` functions.
///
/// ```
/// rilievo_engine::widest! {
///     /// Doubles every value.
///     pub fn double(values: &mut [f32]) {
///         for v in values { *v *= 2.0; }
///     }
/// }
/// let mut v = [1.0, 2.0];
/// double(&mut v);
/// assert_eq!(v, [2.0, 4.0]);
/// ```
#[macro_export]
macro_rules! widest {
    ($($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident : $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block)+) => {$(
        $(#[$meta])*
        $vis fn $name($($arg: $ty),*) $(-> $ret)? {
            #[inline(always)]
            #[allow(clippy::too_many_arguments)]
            fn body($($arg: $ty),*) $(-> $ret)? $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                #[allow(clippy::too_many_arguments)]
                fn wide($($arg: $ty),*) $(-> $ret)? { body($($arg),*) }
                if std::arch::is_x86_feature_detected!("avx2") {
                    // SAFETY: the processor has AVX2, checked on the line above.
                    return unsafe { wide($($arg),*) };
                }
            }
            body($($arg),*)
        }
    )+};
}

/// The whole part of a number, by the conversion that the compiler vectorizes. On desktops that is
/// the unchecked one: 0.5 ns a pixel instead of 4. In a browser it is the checked one: the unchecked
/// one is an instruction that may trap, which there is for single numbers only.
///
/// # Safety
///
/// The whole part fits an `i32`.
#[inline(always)]
pub unsafe fn truncate(value: f32) -> i32 {
    #[cfg(target_family = "wasm")]
    return value as i32;
    #[cfg(not(target_family = "wasm"))]
    // SAFETY: the caller's.
    unsafe {
        value.to_int_unchecked()
    }
}

/// Prefetches the cache lines of a slice that will be read soon. Rows of a tile lie pages apart,
/// where the processor's own prefetching stops; a hint that has an effect only on x86-64.
#[inline(always)]
pub fn prefetch<T>(soon: &[T]) {
    #[cfg(target_arch = "x86_64")]
    for line in soon.chunks((64 / size_of::<T>().max(1)).max(1)) {
        // SAFETY: a hint that reads nothing; SSE is in every x86-64.
        unsafe {
            std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(
                line.as_ptr().cast(),
            )
        };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = soon;
}
