//! The command `fem` with an element more.

fn main() -> std::process::ExitCode {
    fem::cli::main(fem::Registry::standard().with::<plugin_element::Hex8>())
}
