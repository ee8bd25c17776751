//! The command `fem` with a contact law more.

fn main() -> std::process::ExitCode {
    fem::cli::main(fem::Registry::standard().with::<plugin_contact_law::ElasticPlastic>())
}
