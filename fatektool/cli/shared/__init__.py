"""What several commands share: options, output, questions, files, documents."""
