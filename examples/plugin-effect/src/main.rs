//! The command `fem` with an effect more.

fn main() -> std::process::ExitCode {
    fem::cli::main(fem::Registry::standard().with_effect::<plugin_effect::Foundation>())
}
