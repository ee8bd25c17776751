//! The command `fem` with an interface law more.

fn main() -> std::process::ExitCode {
    fem::cli::main(fem::Registry::standard().with::<plugin_interface_law::Exponential>())
}
