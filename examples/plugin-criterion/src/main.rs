//! The command `fem` with a criterion more.

fn main() -> std::process::ExitCode {
    fem::cli::main(fem::Registry::standard().with::<plugin_criterion::YamadaSun>())
}
