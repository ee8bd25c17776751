//! The command `fem` with a reduction more.

fn main() -> std::process::ExitCode {
    fem::cli::main(fem::Registry::standard().with::<plugin_reduction::ShiftedKrylov>())
}
