//! `export!`: a function of the standard, with the type that the headers give it.

/// Defines a function under its name in C and checks it against its type in the headers.
macro_rules! export {
    ($sys:ident :: $type:ident, $name:ident ( $($argument:ident : $of:ty),* $(,)? ) $(-> $result:ty)? $body:block) => {
        #[unsafe(no_mangle)]
        pub(crate) unsafe extern "C" fn $name($($argument: $of),*) $(-> $result)? $body

        const _: $sys::$type = Some($name);
    };
}

pub(crate) use export;
