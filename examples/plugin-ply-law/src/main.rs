//! The command `fem` with a ply law more.

fn main() -> std::process::ExitCode {
    fem::cli::main(fem::Registry::standard().with::<plugin_ply_law::ShearCracks>())
}
