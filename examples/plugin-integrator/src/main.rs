//! The command `fem` with an integrator more.

fn main() -> std::process::ExitCode {
    fem::cli::main(fem::Registry::standard().with::<plugin_integrator::TrBdf2>())
}
