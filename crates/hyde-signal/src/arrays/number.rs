//! Numbers as bytes: reals, whole numbers with and without sign, and truths, of any size.

/// Reads a number from its bytes.
pub(super) type Number = fn(&[u8]) -> f64;

/// How a number of a kind is read, `f8` for a double, and how many bytes it has; none for a kind that is no number.
pub(super) fn number(kind: &str, big: bool) -> Option<(Number, usize)> {
    macro_rules! as_double {
        ($kind:ty) => {{
            const SIZE: usize = size_of::<$kind>();
            #[allow(
                clippy::cast_precision_loss,
                clippy::cast_lossless,
                reason = "a record is of doubles"
            )]
            fn little(bytes: &[u8]) -> f64 {
                bytes
                    .try_into()
                    .map_or(f64::NAN, |bytes| <$kind>::from_le_bytes(bytes) as f64)
            }
            #[allow(
                clippy::cast_precision_loss,
                clippy::cast_lossless,
                reason = "a record is of doubles"
            )]
            fn big_endian(bytes: &[u8]) -> f64 {
                bytes
                    .try_into()
                    .map_or(f64::NAN, |bytes| <$kind>::from_be_bytes(bytes) as f64)
            }
            let read: Number = if big { big_endian } else { little };
            Some((read, SIZE))
        }};
    }
    match kind {
        "f8" => as_double!(f64),
        "f4" => as_double!(f32),
        "i1" => as_double!(i8),
        "i2" => as_double!(i16),
        "i4" => as_double!(i32),
        "i8" => as_double!(i64),
        "u1" | "b1" => as_double!(u8),
        "u2" => as_double!(u16),
        "u4" => as_double!(u32),
        "u8" => as_double!(u64),
        _ => None,
    }
}
