"""What a screen shows, without a screen: a lab that runs, or a recording that is played."""
