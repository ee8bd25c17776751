//! The command `fem` with the standard plug-ins.

fn main() -> std::process::ExitCode {
    fem::cli::main(fem::Registry::standard())
}
